// Lines about outputs that no program receives.
#include "consumers/osc/output_report.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace dance {
namespace {

class OutputReportTest : public testing::Test {
 protected:
  OutputReportTest() {
    auto receiver = UdpSocket::bind(Address::loopback(0));
    at_ = receiver->local_address();
    sender_.emplace(*UdpSocket::connect(at_));
  }
  // Seconds in which datagrams are sent; the lines that they bring.
  std::vector<std::string> lines_of(int seconds) {
    std::vector<std::string> lines;
    const std::vector<std::uint8_t> bytes{1, 2, 3};
    for (int second = 0; second < seconds; ++second) {
      for (int i = 0; i < 30; ++i) sender_->send_now({}, bytes);
      if (auto line = report_.tick(sender_->counters(), at_)) lines.push_back(*line);
    }
    return lines;
  }

  Address at_;
  std::optional<UdpSocket> sender_;
  OutputReport report_{"vmc"};
};

TEST_F(OutputReportTest, NamesAPortWhereNoProgramReceivesOnce) {
  const auto lines = lines_of(60);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("vmc: no program receives at " + at_.to_string()), std::string::npos);
  EXPECT_NE(lines[0].find("--address"), std::string::npos) << lines[0];
}

TEST_F(OutputReportTest, ReportsAReceiverThatHasStarted) {
  EXPECT_EQ(lines_of(4).size(), 1u);
  const auto receiver = UdpSocket::bind(at_);
  ASSERT_TRUE(receiver);
  const auto lines = lines_of(60);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("receives at " + at_.to_string() + " now"), std::string::npos);
}

TEST_F(OutputReportTest, HasNoLineForAReceiverThatRestarts) {
  auto receiver = UdpSocket::bind(at_);
  ASSERT_TRUE(receiver);
  EXPECT_TRUE(lines_of(5).empty());
  *receiver = *UdpSocket::bind(Address::loopback(0));
  EXPECT_TRUE(lines_of(2).empty());
  receiver = UdpSocket::bind(at_);
  ASSERT_TRUE(receiver);
  EXPECT_TRUE(lines_of(60).empty());
}

}  // namespace
}  // namespace dance

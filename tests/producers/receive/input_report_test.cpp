// Lines about receivers that get nothing usable.
#include "producers/receive/input_report.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace dance {
namespace {

class FakeReceiver final : public PoseReceiver {
 public:
  std::string summary() const override { return "summary"; }
  InputState state() const override { return now; }
  std::string diagnosis() const override {
    return now.arrived == 0 ? nothing_arrives_text(now.at) : "the cure";
  }
  InputState now;
};

class InputReportTest : public testing::Test {
 protected:
  InputReportTest() { receiver_.now.at = Address::loopback(39539); }
  // Returns the lines of that many seconds. In each second datagrams arrive and give poses.
  std::vector<std::string> lines_of(int seconds, std::uint64_t datagrams = 0,
                                    std::uint64_t poses = 0) {
    std::vector<std::string> lines;
    for (int second = 0; second < seconds; ++second) {
      receiver_.now.arrived += datagrams;
      receiver_.now.poses += poses;
      for (std::string& line : report_.tick(receiver_, elsewhere_, arrived_elsewhere_, now_))
        lines.push_back(std::move(line));
      now_ = now_ + Duration::s(1);
    }
    return lines;
  }
  static bool has(const std::string& line, const std::string& words) {
    return line.find(words) != std::string::npos;
  }

  FakeReceiver receiver_;
  InputReport report_{"vmc"};
  Address elsewhere_ = *Address::resolve("[::1]:39539");
  std::uint64_t arrived_elsewhere_ = 0;
  MonoTime now_ = MonoTime::from_us(5'000'000);
};

TEST_F(InputReportTest, ReportsItsAddressWhenNothingArrivesForThreeSeconds) {
  EXPECT_TRUE(lines_of(3).empty());
  const auto lines = lines_of(60);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(has(lines[0], "vmc: nothing arrives at 127.0.0.1:39539: ")) << lines[0];
  EXPECT_TRUE(has(lines[0], "::1")) << lines[0];
  EXPECT_TRUE(has(lines[0], "--listen 0.0.0.0:39539")) << lines[0];
}

TEST_F(InputReportTest, ReportsUnusableDatagramsAndTheCure) {
  receiver_.now.from = Address::loopback(5000);
  EXPECT_TRUE(lines_of(3, 60).empty());
  const auto lines = lines_of(60, 60);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0],
            "vmc: 240 datagrams at 127.0.0.1:39539 from 127.0.0.1:5000 make no pose: the cure");
}

TEST_F(InputReportTest, ReportsDatagramsAtTheOtherLoopbackAddress) {
  EXPECT_EQ(lines_of(5).size(), 1u);
  arrived_elsewhere_ = 12;
  const auto lines = lines_of(60);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(has(lines[0], "datagrams arrive at [::1]:39539")) << lines[0];
  EXPECT_TRUE(has(lines[0], "send to 127.0.0.1:39539")) << lines[0];
  EXPECT_TRUE(has(lines[0], "--listen [::1]:39539")) << lines[0];
}

TEST_F(InputReportTest, ReportsOnceThatPosesArriveAndOnceThatTheyStop) {
  EXPECT_TRUE(lines_of(10, 60, 60).empty());
  EXPECT_EQ(lines_of(60).size(), 1u) << "the sender has ended";
  const auto back = lines_of(60, 60, 60);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0], "vmc: poses arrive");
  EXPECT_TRUE(lines_of(2, 60, 0).empty()) << "a short gap";
  EXPECT_TRUE(lines_of(10, 60, 60).empty());
}

TEST_F(InputReportTest, ReportsAnUnusableClockOfTheSenderOnce) {
  receiver_.now.is_clock_unusable = true;
  const auto lines = lines_of(60, 60, 60);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(has(lines[0], "clock")) << lines[0];
  EXPECT_TRUE(has(lines[0], "times of arrival")) << lines[0];
}

}  // namespace
}  // namespace dance

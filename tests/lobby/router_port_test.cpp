// RouterPort against a simulated router on loopback, with valid and malformed answers.
#include "lobby/invite/router_port.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "core/net/machine_addresses.h"

namespace dance {
namespace {

using RouterBytes = std::vector<std::uint8_t>;

MonoTime router_ms(std::int64_t ms) { return MonoTime() + Duration::s(50) + Duration::ms(ms); }

class RouterPortTest : public testing::Test {
 protected:
  void SetUp() override {
    auto bound = UdpSocket::bind(Address::loopback(0), {8, 64});
    ASSERT_TRUE(bound);
    router_.emplace(std::move(*bound));
    auto started = RouterPort::start(router_->local_address(), 7400, router_ms(0));
    ASSERT_TRUE(started) << started.error().what;
    port_.emplace(std::move(*started));
  }
  // Waits up to 2 s for that many requests; loopback is much faster.
  std::vector<RouterBytes> requests(std::size_t count) {
    std::vector<RouterBytes> all;
    for (int i = 0; i < 200 && all.size() < count; ++i) {
      for (const UdpSocket::Datagram& it : router_->receive()) {
        guest_ = it.from;
        all.emplace_back(it.bytes.begin(), it.bytes.end());
      }
      if (all.size() < count) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return all;
  }
  void answer(const RouterBytes& bytes) { router_->send_now(guest_, bytes); }
  bool works_until(MonoTime now, RouterPort::State state) {
    for (int i = 0; i < 200; ++i) {
      port_->work(now);
      if (port_->state() == state) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  static constexpr std::uint8_t kHigh = 7400 >> 8, kLow = 7400 & 0xff;
  std::optional<UdpSocket> router_;
  std::optional<RouterPort> port_;
  Address guest_;
};

const RouterBytes kAddress{0, 128, 0, 0, 0, 0, 0, 9, 203, 0, 113, 5};

TEST_F(RouterPortTest, IsOpenOnceAddressAndPortAreKnownAndRenewsTheRequest) {
  const auto asked = requests(2);
  ASSERT_EQ(asked.size(), 2u);
  EXPECT_EQ(asked[0], (RouterBytes{0, 0}));
  EXPECT_EQ(asked[1], (RouterBytes{0, 1, 0, 0, kHigh, kLow, kHigh, kLow, 0, 0, 14, 16}));
  answer(kAddress);
  answer({0, 129, 0, 0, 0, 0, 0, 9, kHigh, kLow, kHigh, kLow, 0, 0, 14, 16});
  ASSERT_TRUE(works_until(router_ms(100), RouterPort::State::kOpen));
  EXPECT_EQ(port_->address(), "203.0.113.5");
  EXPECT_TRUE(router_->receive().empty()) << "nothing is due yet";
  port_->work(router_ms(1'800'200));
  EXPECT_EQ(requests(2).size(), 2u) << "half of the hour later";
  port_->close();
  const auto last = requests(1);
  ASSERT_EQ(last.size(), 1u);
  EXPECT_EQ(last[0], (RouterBytes{0, 1, 0, 0, kHigh, kLow, 0, 0, 0, 0, 0, 0}));
}

TEST_F(RouterPortTest, AddressIncludesADifferentOuterPort) {
  requests(2);
  answer(kAddress);
  answer({0, 129, 0, 0, 0, 0, 0, 9, kHigh, kLow, 0x20, 0x01, 0, 0, 14, 16});
  ASSERT_TRUE(works_until(router_ms(100), RouterPort::State::kOpen));
  EXPECT_EQ(port_->address(), "203.0.113.5:8193");
  EXPECT_FALSE(port_->is_behind_another());
}

TEST_F(RouterPortTest, ReportsARouterBehindAnother) {
  requests(2);
  answer({0, 128, 0, 0, 0, 0, 0, 9, 10, 0, 0, 5});
  answer({0, 129, 0, 0, 0, 0, 0, 9, kHigh, kLow, kHigh, kLow, 0, 0, 14, 16});
  ASSERT_TRUE(works_until(router_ms(100), RouterPort::State::kOpen));
  EXPECT_TRUE(port_->is_behind_another());
}

TEST_F(RouterPortTest, ReportsSilenceAndRefusal) {
  for (std::int64_t ms = 0; ms < 20'000; ms += 100) port_->work(router_ms(ms));
  EXPECT_EQ(port_->state(), RouterPort::State::kSilent);
  EXPECT_EQ(requests(10).size(), 10u) << "five times two requests";
  EXPECT_TRUE(router_->receive().empty()) << "and no more";
  SetUp();
  requests(2);
  answer({0, 129, 0, 2, 0, 0, 0, 9, kHigh, kLow, 0, 0, 0, 0, 0, 0});
  EXPECT_TRUE(works_until(router_ms(100), RouterPort::State::kRefused));
  EXPECT_EQ(port_->address(), "");
}

TEST_F(RouterPortTest, IgnoresMalformedAnswers) {
  requests(2);
  const RouterBytes whole{0, 129, 0, 0, 0, 0, 0, 9, kHigh, kLow, kHigh, kLow, 0, 0, 14, 16};
  for (std::size_t length = 0; length < whole.size(); ++length)
    answer(RouterBytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)));
  answer({1, 129, 0, 0, 0, 0, 0, 9, kHigh, kLow, kHigh, kLow, 0, 0, 14, 16});
  answer({0, 129, 0, 0, 0, 0, 0, 9, 0, 1, 0, 1, 0, 0, 14, 16});
  answer({0, 128, 0, 0, 0, 0, 0, 9, 0, 0, 0, 0});
  answer(kAddress);
  for (int i = 0; i < 20; ++i) {
    port_->work(router_ms(100));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(port_->state(), RouterPort::State::kAsking);
}

TEST_F(RouterPortTest, ReadsABoundedNumberOfDatagramsPerTurn) {
  requests(2);
  for (int i = 0; i < 100; ++i) answer({0});
  answer(kAddress);
  answer({0, 129, 0, 0, 0, 0, 0, 9, kHigh, kLow, kHigh, kLow, 0, 0, 14, 16});
  port_->work(router_ms(100));
  EXPECT_EQ(port_->state(), RouterPort::State::kAsking) << "the answers are behind the flood";
  EXPECT_TRUE(works_until(router_ms(100), RouterPort::State::kOpen));
}

TEST(DefaultRouter, IsReadFromTheTableOfRoutes) {
  const std::string heading = "Iface\tDestination\tGateway \tFlags\tRefCnt\tUse\tMetric\tMask\n";
  EXPECT_EQ(
      router_in(heading + "eth0\t00000000\t0101A8C0\t0003\t0\t0\t100\t00000000\n").to_string(),
      "192.168.1.1:0");
  EXPECT_FALSE(
      router_in(heading + "eth0\t0001A8C0\t00000000\t0001\t0\t0\t100\t00FFFFFF\n").is_set());
  EXPECT_FALSE(router_in("").is_set());
  EXPECT_FALSE(router_in(heading + "eth0\t00000000\t01\n\n").is_set());
}

}  // namespace
}  // namespace dance

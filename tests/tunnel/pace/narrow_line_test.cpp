// A crowd before a receiver whose line is too narrow for it, and one whose line is not.
#include <gtest/gtest.h>

#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

constexpr int kCrowd = 10;
constexpr std::int64_t kFrame_ms = 20;

std::string name_of(int number) { return "guest-" + std::to_string(number); }

// Light to encode, and every pose as many bytes.
void plain_only(SimulatedTunnel& tunnel) {
  if (!tunnel.link_options.codecs.try_push({CodecId::kPlain, 0})) std::abort();
}

// Guests in a row, a metre apart, spread over the frame; the line down to the first bears so much.
class NarrowLine : public ::testing::Test {
 protected:
  NarrowLine() {
    plain_only(tunnel_);
    for (int i = 0; i < kCrowd; ++i) {
      House& house = *houses_.emplace_back(&tunnel_.add_house("crowd", {name_of(i)}));
      house.link->send(guest(name_of(i)), Skeleton(), tunnel_.time_in(house));
      Placement stands;
      stands.x_m = static_cast<float>(i);
      house.link->send(guest(name_of(i)), stands, tunnel_.time_in(house));
    }
    tunnel_.on_datagram = [this](bool to_server, PeerId peer, wire::Bytes bytes) {
      if (to_server || peer != first().peer) return true;
      const auto size = static_cast<double>(bytes.size() + wire::kSealOverhead + kIpUdp_bytes);
      bytes_ += size;
      // What is before it in the queue delays it; a quarter of a second is the most.
      if (queued_bytes_ + size > line_bytes_per_s_ * 0.25) return false;
      queued_bytes_ += size;
      first().down = kDown + Duration::seconds(queued_bytes_ / line_bytes_per_s_);
      return true;
    };
  }

  House& first() { return *houses_[0]; }
  const SessionPace& pace() {
    for (const ServerSession& session : tunnel_.server().sessions())
      if (session.in_use && session.peer == first().peer) return session.pace;
    std::abort();
  }
  void dance(Duration duration) {
    tunnel_.run(duration, [this] {
      queued_bytes_ = std::max(0.0, queued_bytes_ - line_bytes_per_s_ * 1e-3);
      const auto moment = static_cast<int>(tunnel_.now().since_zero_us() / 1000 % kFrame_ms);
      for (int i = 0; i < kCrowd; ++i)
        if (i % kFrame_ms == moment)
          tunnel_.dance(*houses_[static_cast<std::size_t>(i)], guest(name_of(i)));
    });
  }
  // Of each guest in so many seconds, what share of all the first one hears.
  std::vector<double> shares(int seconds) {
    first().poses.clear();
    bytes_ = 0.0;
    dance(Duration::s(seconds));
    std::vector<double> shares;
    for (int i = 0; i < kCrowd; ++i)
      shares.push_back(static_cast<double>(first().heard_of(guest(name_of(i)))) * kFrame_ms /
                       (1000.0 * seconds));
    bytes_per_s_ = bytes_ / seconds;
    return shares;
  }

  static constexpr Duration kDown = Duration::ms(5);
  SimulatedTunnel tunnel_;
  std::vector<House*> houses_;
  double line_bytes_per_s_ = 1e9;
  double queued_bytes_ = 0.0;
  double bytes_ = 0.0, bytes_per_s_ = 0.0;
};

TEST_F(NarrowLine, AWideOneTakesEveryPoseAtOnce) {
  dance(Duration::s(5));
  const auto all = shares(5);
  for (int i = 1; i < kCrowd; ++i) EXPECT_NEAR(all[static_cast<std::size_t>(i)], 1.0, 0.02) << i;
  EXPECT_FALSE(pace().budget.is_limited());
  EXPECT_EQ(pace().window, Duration());
  for (const auto& heard : first().poses)
    ASSERT_LT((heard.at - heard.pose.capture_time).as_ms(), 21.0) << "10 old, 5 up, 5 down";
}

TEST_F(NarrowLine, TheNearAndTheChosenComeInFullAndTheFarMoreSeldom) {
  Interest interest;
  ASSERT_TRUE(interest.guests.try_push({guest(name_of(kCrowd - 1)), 1}));
  first().link->set_interest(interest, tunnel_.time_in(first()));
  dance(Duration::s(5));
  shares(5);
  const double all = bytes_per_s_;
  line_bytes_per_s_ = 0.4 * all;
  dance(Duration::s(20));
  const auto heard = shares(40);
  EXPECT_TRUE(pace().budget.is_limited());
  EXPECT_GT(pace().ramp, 0u);
  EXPECT_LT(bytes_per_s_, 1.1 * line_bytes_per_s_);
  EXPECT_GT(bytes_per_s_, 0.4 * line_bytes_per_s_) << "what there is, is used";
  // Who was named, though the farthest, and the nearest.
  EXPECT_GT(heard[kCrowd - 1], 0.8);
  EXPECT_GT(heard[1], 0.55);
  // The farther the rarer, and nobody is left out.
  EXPECT_LT(heard[kCrowd - 2], 0.3);
  for (int i = 1; i < kCrowd - 1; ++i) EXPECT_GT(heard[static_cast<std::size_t>(i)], 0.08) << i;
  for (int i = 2; i < kCrowd - 1; ++i)
    EXPECT_LE(heard[static_cast<std::size_t>(i)], heard[static_cast<std::size_t>(i) - 1] + 0.1)
        << i;
}

TEST_F(NarrowLine, OnlyItsOwnReceiverPays) {
  dance(Duration::s(5));
  shares(5);
  line_bytes_per_s_ = 0.3 * bytes_per_s_;
  dance(Duration::s(20));
  const auto before = houses_[1]->poses.size();
  dance(Duration::s(5));
  EXPECT_NEAR(static_cast<double>(houses_[1]->poses.size() - before),
              (kCrowd - 1) * 5.0 * 1000.0 / kFrame_ms, 30.0);
}

TEST_F(NarrowLine, EverythingComesAgainWhenItIsWide) {
  dance(Duration::s(5));
  shares(5);
  line_bytes_per_s_ = 0.3 * bytes_per_s_;
  dance(Duration::s(30));
  ASSERT_TRUE(pace().budget.is_limited());
  line_bytes_per_s_ = 1e9;
  dance(Duration::s(60));
  EXPECT_FALSE(pace().budget.is_limited());
  const auto all = shares(2);
  for (int i = 1; i < kCrowd; ++i) EXPECT_NEAR(all[static_cast<std::size_t>(i)], 1.0, 0.05) << i;
  EXPECT_EQ(pace().window, Duration());
  EXPECT_EQ(pace().ramp, 0u);
}

TEST(BusyServer, LetsPosesWaitWhereItSendsMoreThanItShould) {
  ServerLimits limits;
  limits.eager_records_per_second = 1500.0;
  SimulatedTunnel tunnel(limits);
  plain_only(tunnel);
  std::vector<House*> houses;
  for (int i = 0; i < kCrowd; ++i) houses.push_back(&tunnel.add_house("crowd", {name_of(i)}));
  const auto dance = [&](Duration duration) {
    tunnel.run(duration, [&] {
      const auto moment = static_cast<int>(tunnel.now().since_zero_us() / 1000 % kFrame_ms);
      for (int i = 0; i < kCrowd; ++i)
        if (i % kFrame_ms == moment)
          tunnel.dance(*houses[static_cast<std::size_t>(i)], guest(name_of(i)));
    });
  };
  dance(Duration::s(3));
  const ServerCounters before = tunnel.server().counters();
  dance(Duration::s(3));
  const ServerCounters& after = tunnel.server().counters();
  // 10 · 9 poses, fifty times a second, three to a datagram; the rest is pongs and the like.
  EXPECT_NEAR(static_cast<double>(after.records_out - before.records_out), 13500.0, 200.0);
  EXPECT_LT(static_cast<double>(after.datagrams_out - before.datagrams_out), 7000.0);
  for (const ServerSession& session : tunnel.server().sessions()) {
    EXPECT_FALSE(session.in_use && session.pace.budget.is_limited());
  }
}

}  // namespace
}  // namespace dance

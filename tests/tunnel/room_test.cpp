// The lattice codec through links and server, over lines that lose: whatever arrives decodes.
#include <gtest/gtest.h>

#include "core/pose/skeleton.h"
#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

class LatticeRoom : public ::testing::Test {
 protected:
  LatticeRoom() {
    EXPECT_EQ(known_codecs().front().id, CodecId::kLattice);
    EXPECT_TRUE(tunnel.link_options.codecs.try_push(known_codecs().front()));
    for (int i = 0; i < 6; ++i)
      add("guest-" + std::to_string(i), 1.55f + 0.07f * static_cast<float>(i));
    tunnel.run(Duration::s(1));
  }
  House& add(const std::string& name, float height_m) {
    House& house = tunnel.add_house("salsa", {name});
    house.link->send(guest(name), average_skeleton(height_m), tunnel.time_in(house));
    dance.dancers.push_back({&house, guest(name)});
    return house;
  }
  void lose(double share) {
    tunnel.on_datagram = [this, share](bool, PeerId, wire::Bytes) {
      return random.uniform() >= share;
    };
  }
  LinkCounters sum() const {
    LinkCounters sum;
    for (const auto& [house, who] : dance.dancers) {
      const LinkCounters& c = house->link->counters();
      sum.poses_sent += c.poses_sent;
      sum.poses_received += c.poses_received;
      sum.poses_delivered += c.poses_delivered;
      sum.reference_missing += c.reference_missing;
      sum.skeleton_missing += c.skeleton_missing;
      sum.invalid += c.invalid;
    }
    return sum;
  }
  bool all_refer_to(References references) const {
    return std::all_of(dance.dancers.begin(), dance.dancers.end(), [&](const auto& dancer) {
      return dancer.first->link->local_stats().at(0).references == references;
    });
  }

  // What one pose alone comes to: repetition has tests of its own.
  SimulatedTunnel tunnel{{.repeats = false}};
  Dance dance{tunnel, {}};
  Random random{23};
};

TEST_F(LatticeRoom, WhateverArrivesOverALosingLineDecodes) {
  lose(0.05);
  dance.run(Duration::s(2));
  ASSERT_TRUE(all_refer_to(References::kAcknowledged));
  const LinkCounters before = sum();
  dance.run(Duration::s(2));
  const LinkCounters after = sum();
  const auto received = after.poses_received - before.poses_received;
  const auto delivered = after.poses_delivered - before.poses_delivered;
  // 6 dancers, 5 receivers each, 62.5 Hz, two lines that lose.
  EXPECT_NEAR(static_cast<double>(received), 6 * 5 * 125 * 0.9, 150.0);
  EXPECT_GE(static_cast<double>(delivered), 0.995 * static_cast<double>(received));
  EXPECT_EQ(after.reference_missing, before.reference_missing);
  EXPECT_EQ(after.invalid, 0u) << "nothing is malformed, from the begin on";
  EXPECT_TRUE(all_refer_to(References::kAcknowledged));
}

TEST_F(LatticeRoom, ANewcomerDecodesEverybodyWithinARoundTripOverTheSenders) {
  lose(0.05);
  dance.run(Duration::s(2));
  ASSERT_TRUE(all_refer_to(References::kAcknowledged));
  tunnel.on_datagram = nullptr;
  tunnel.link_options.intra_frame_period = Duration();
  House& newcomer = add("carol", 1.63f);
  const LinkCounters before = sum();
  // Hello and welcome 10 ms, the ping 5 ms: the newcomer is known. To the senders 5 ms, which are
  // told with what waits for them, up to a frame, to the server 5 ms, down 5 ms.
  dance.run(Duration::ms(1 + 10 + 5 + 5 + 1 + 17 + 5 + 5));
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_GE(newcomer.heard_of(dance.dancers[i].second), 1u) << i;
  dance.run(Duration::s(1));
  const LinkCounters after = sum();
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_GE(newcomer.heard_of(dance.dancers[i].second), 60u) << i;
  EXPECT_EQ(after.invalid, 0u);
  // What came to the newcomer before the intra frame, and to nobody else.
  EXPECT_EQ(after.reference_missing - before.reference_missing,
            newcomer.link->counters().reference_missing);
  EXPECT_LE(newcomer.link->counters().reference_missing, 6u * 3u);
}

TEST_F(LatticeRoom, ADancerIsSeenFromTheFirstPoseOn) {
  std::vector<House*> houses;
  for (int i = 0; i < 8; ++i)
    houses.push_back(&tunnel.add_house("salsa", {"late-" + std::to_string(i)}));
  dance.run(Duration::ms(200));
  const LinkCounters before = sum();
  // A producer says the proportions, and dances at once; one dancer a few milliseconds after the
  // other.
  for (int ms = 0; ms < 100; ++ms) {
    for (int i = 0; i < 8; ++i) {
      const std::string name = "late-" + std::to_string(i);
      House& house = *houses[static_cast<std::size_t>(i)];
      if (ms == 3 * i)
        house.link->send(guest(name), average_skeleton(1.5f + 0.05f * static_cast<float>(i)),
                         tunnel.time_in(house));
      if (ms >= 3 * i && (ms - 3 * i) % 16 == 0) tunnel.dance(house, guest(name));
    }
    dance.run(Duration::ms(1));
  }
  dance.run(Duration::ms(100));
  EXPECT_EQ(sum().skeleton_missing, before.skeleton_missing);
  for (int i = 0; i < 8; ++i) {
    const GuestId who = guest("late-" + std::to_string(i));
    EXPECT_EQ(houses[static_cast<std::size_t>(i)]->link->counters().skeleton_missing, 0u) << i;
    for (const auto& [house, dancer] : dance.dancers)
      EXPECT_EQ(house->heard_of(who), static_cast<std::size_t>((99 - 3 * i) / 16 + 1)) << i;
  }
}

TEST_F(LatticeRoom, TheRateMakesPosesCoarserAndTheyStillDecode) {
  tunnel.link_options.pose_bytes_per_second = 200.0;
  House& thrifty = add("dora", 1.7f);
  dance.run(Duration::s(6));
  EXPECT_EQ(thrifty.link->local_stats().at(0).quality_m, 0.005);
  EXPECT_EQ(dance.dancers[0].first->link->local_stats().at(0).quality_m, 0.001);
  EXPECT_GE(dance.dancers[0].first->heard_of(guest("dora")), 350u);
  EXPECT_EQ(sum().invalid, 0u);
}

}  // namespace
}  // namespace dance

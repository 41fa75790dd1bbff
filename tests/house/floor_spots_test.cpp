// Tests of where synthetic dancers dance, so that no two overlap. Houses receive each other's poses
// a quarter of a second late, and their clocks differ a little.
#include "house/dancer/floor_spots.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "house/dancer/placed_salsa.h"

namespace dance {
namespace {

using Eigen::Vector3f;

const MonoTime kBegin = MonoTime::from_us(1'000'000'000);
constexpr Duration kFrame = Duration::ms(33);

GuestId guest(const std::string& name) { return *GuestId::parse(name); }

std::unique_ptr<PlacedSalsa> salsa(const std::string& name, std::optional<SalsaRole> chosen,
                                   MonoTime arrival, MonoTime start = MonoTime()) {
  return std::make_unique<PlacedSalsa>(SalsaDancer(*checked_style(SalsaStyle())),
                                       FloorSpots(guest(name), chosen, arrival), start);
}

// Houses in one room, each with a synthetic dancer; the others' poses are `delay` old.
class Room {
 public:
  explicit Room(Duration delay = Duration::ms(250)) : delay_(delay) {}

  PlacedSalsa& join(const std::string& name, std::optional<SalsaRole> chosen = std::nullopt) {
    // Wall clocks of two machines differ by some 80 ms.
    const MonoTime start = MonoTime() + Duration::ms(dancers_.size() % 2 == 0 ? 40 : -40);
    dancers_.push_back({guest(name), salsa(name, chosen, now_, start), start, {}, {}});
    return *dancers_.back().placed;
  }
  PlacedSalsa& dancer(const std::string& name) {
    for (Dancer& each : dancers_)
      if (each.guest == guest(name)) return *each.placed;
    ADD_FAILURE() << name;
    return *dancers_.front().placed;
  }
  void leave(const std::string& name) {
    std::erase_if(dancers_, [&](const Dancer& dancer) { return dancer.guest == guest(name); });
  }
  void dance(Duration length) {
    for (const MonoTime end = now_ + length; now_ < end; now_ = now_ + kFrame) {
      for (Dancer& dancer : dancers_) {
        for (Dancer& other : dancers_)
          if (!other.sent.empty() && other.sent.front().capture_time <= now_ - delay_)
            dancer.placed->update_other(other.guest, newest_of(other), now_);
        dancer.placed->dance_at(now_ - dancer.start, dancer.pose);
        dancer.pose.capture_time = now_;
        dancer.sent.push_back(dancer.pose);
        if (dancer.sent.size() > 100) dancer.sent.pop_front();
      }
      note_pairs();
    }
  }
  // The longest time that two dancers overlapped who are no couple.
  Duration longest_overlap() const { return longest_; }

 private:
  struct Dancer {
    GuestId guest;
    std::unique_ptr<PlacedSalsa> placed;
    MonoTime start;
    Pose pose;
    std::deque<Pose> sent;
  };
  const Pose& newest_of(const Dancer& other) const {
    std::size_t i = 0;
    while (i + 1 < other.sent.size() && other.sent[i + 1].capture_time <= now_ - delay_) ++i;
    return other.sent[i];
  }
  void note_pairs() {
    bool is_any = false;
    for (std::size_t a = 0; a < dancers_.size(); ++a)
      for (std::size_t b = a + 1; b < dancers_.size(); ++b) {
        const FloorSpot& one = dancers_[a].placed->spot();
        const FloorSpot& other = dancers_[b].placed->spot();
        if (one.couple == other.couple && one.role != other.role) continue;  // in hold
        Vector3f between = dancers_[a].pose.p_WH_m - dancers_[b].pose.p_WH_m;
        between.y() = 0.0f;
        is_any |= between.norm() < FloorSpots::kOverlap_m;
      }
    overlap_ = is_any ? overlap_ + kFrame : Duration();
    longest_ = std::max(longest_, overlap_);
  }

  Duration delay_;
  MonoTime now_ = kBegin;
  std::vector<Dancer> dancers_;
  Duration overlap_, longest_;
};

TEST(FloorSpots, SecondDancerFollowsTheFirst) {
  for (const auto& [first, second] : {std::pair("alice", "bob"), {"bob", "alice"}}) {
    Room room;
    const PlacedSalsa& host = room.join(first);
    room.dance(Duration::s(20));
    const PlacedSalsa& friends = room.join(second);
    room.dance(Duration::s(60));
    EXPECT_EQ(host.spot(), (FloorSpot{SalsaRole::kLead, 0})) << first;
    EXPECT_EQ(friends.spot(), (FloorSpot{SalsaRole::kFollow, 0})) << second;
    EXPECT_LE(room.longest_overlap(), Duration::ms(500)) << first;
  }
}

TEST(FloorSpots, TwoDancersWhoArriveTogetherBecomeACouple) {
  Room room;
  const PlacedSalsa& alice = room.join("alice");
  const PlacedSalsa& bob = room.join("bob");
  room.dance(Duration::s(30));
  EXPECT_EQ(alice.spot().couple, 0u);
  EXPECT_EQ(bob.spot().couple, 0u);
  EXPECT_NE(alice.spot().role, bob.spot().role);
  EXPECT_LT(room.longest_overlap(), Duration::ms(1500));
}

TEST(FloorSpots, DancerWithoutChosenRoleYieldsToOneWithIt) {
  for (const SalsaRole chosen : {SalsaRole::kLead, SalsaRole::kFollow}) {
    Room room;
    const PlacedSalsa& host = room.join("alice");
    room.dance(Duration::s(20));
    const PlacedSalsa& friends = room.join("bob", chosen);
    room.dance(Duration::s(30));
    EXPECT_EQ(friends.spot().role, chosen);
    EXPECT_EQ(friends.spot().couple, 0u);
    EXPECT_EQ(host.spot().couple, 0u);
    EXPECT_NE(host.spot().role, chosen);
  }
}

TEST(FloorSpots, TwoDancersWithOneChosenRoleDanceInTwoPlaces) {
  Room room;
  const PlacedSalsa& alice = room.join("alice", SalsaRole::kFollow);
  const PlacedSalsa& bob = room.join("bob", SalsaRole::kFollow);
  room.dance(Duration::s(30));
  EXPECT_EQ(alice.spot(), (FloorSpot{SalsaRole::kFollow, 0}));
  EXPECT_EQ(bob.spot(), (FloorSpot{SalsaRole::kFollow, 1}));
}

TEST(FloorSpots, ThirtyDancersWhoArriveOneByOneDoNotOverlap) {
  Room room(Duration::ms(120));
  for (int i = 0; i < 30; ++i) {
    if (i == 1) room.dance(Duration::s(6));  // the host
    // Names in no order.
    room.join("guest-" + std::to_string((i * 17) % 30));
    room.dance(Duration::s(3));
  }
  room.dance(Duration::s(20));
  EXPECT_LE(room.longest_overlap(), Duration::ms(500));
}

TEST(FloorSpots, NewcomerTakesTheSpotOfADancerWhoHasLeft) {
  Room room;
  room.join("alice");
  room.dance(Duration::s(6));
  const PlacedSalsa& bob = room.join("bob");
  room.dance(Duration::s(6));
  room.leave("alice");
  room.dance(Duration::s(6));
  EXPECT_EQ(bob.spot(), (FloorSpot{SalsaRole::kFollow, 0})) << "nobody moves when somebody leaves";
  const PlacedSalsa& carol = room.join("carol");
  room.dance(Duration::s(6));
  EXPECT_EQ(carol.spot(), (FloorSpot{SalsaRole::kLead, 0}));
}

// Partners come near each other in figures, which is no reason to part.
TEST(FloorSpots, CoupleStaysTogetherForTenMinutes) {
  Room room;
  const PlacedSalsa& alice = room.join("alice");
  const PlacedSalsa& bob = room.join("bob");
  room.dance(Duration::s(10));
  const FloorSpot lead = alice.spot(), follow = bob.spot();
  room.dance(Duration::s(600));
  EXPECT_EQ(alice.spot(), lead);
  EXPECT_EQ(bob.spot(), follow);
}

TEST(FloorSpots, CouplesAreTwoMetresApart) {
  for (std::size_t a = 0; a < kFloorCouples; ++a)
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_GT((couple_middle_m(a) - couple_middle_m(b)).norm(), 2.0f) << a << ' ' << b;
}

// Somebody who was there at the arrival comes near for a moment, much later.
TEST(FloorSpots, CoupleDoesNotPartAfterAMomentaryOverlap) {
  FloorSpots spots(guest("zoe"), std::nullopt, kBegin);
  const std::array<Vector3f, 2> hips{Vector3f(0, 1, 0), Vector3f(0, 1, 0.6f)};
  MonoTime now = kBegin;
  const auto dance = [&](float distance_m, Duration length) {
    for (const MonoTime end = now + length; now < end; now = now + kFrame) {
      spots.update_other(guest("alice"), Vector3f(0, 1, distance_m), now);
      spots.update(hips, now);
    }
  };
  dance(0.6f, Duration::s(60));
  dance(0.2f, Duration::s(2));
  EXPECT_EQ(spots.spot(), (FloorSpot{SalsaRole::kLead, 0}));
  dance(0.2f, Duration::s(2));
  EXPECT_NE(spots.spot(), (FloorSpot{SalsaRole::kLead, 0})) << "an overlap that lasts";
}

// A newcomer finds one dancer at each of two spots, one pose after the other.
TEST(PlacedSalsa, GlidesToItsNewSpot) {
  const auto bob = salsa("bob", std::nullopt, kBegin);
  const auto alice = salsa("alice", SalsaRole::kLead, kBegin - Duration::s(100));
  const auto carol = salsa("carol", SalsaRole::kFollow, kBegin - Duration::s(100));
  Pose pose, other, before;
  float fastest_m_s = 0.0f;
  for (int i = 0; i < 400; ++i) {
    const MonoTime now = kBegin + Duration::ms(10) * i;
    alice->dance_at(now - MonoTime(), other);
    if (i >= 20) bob->update_other(guest("alice"), other, now);
    carol->dance_at(now - MonoTime(), other);
    if (i >= 24) bob->update_other(guest("carol"), other, now);
    bob->dance_at(now - MonoTime(), pose);
    ASSERT_TRUE(is_valid(pose));
    if (i > 0) fastest_m_s = std::max(fastest_m_s, (pose.p_WH_m - before.p_WH_m).norm() / 0.01f);
    before = pose;
  }
  EXPECT_EQ(bob->spot().couple, 1u);
  EXPECT_LT(fastest_m_s, 8.0f) << "2.4 m in 0.7 s";
}

TEST(FloorSpots, ChangesAChosenRoleWhileDancingAndGivesThePartnerTheOther) {
  Room room;
  room.join("ann");
  room.dance(Duration::s(2));
  room.join("bob");
  room.dance(Duration::s(4));
  ASSERT_EQ(room.dancer("ann").spot().role, SalsaRole::kLead);
  ASSERT_EQ(room.dancer("bob").spot(), (FloorSpot{SalsaRole::kFollow, 0}));
  room.dancer("ann").choose_role(SalsaRole::kFollow);
  room.dance(Duration::s(8));
  EXPECT_EQ(room.dancer("ann").spot(), (FloorSpot{SalsaRole::kFollow, 0}));
  EXPECT_EQ(room.dancer("bob").spot(), (FloorSpot{SalsaRole::kLead, 0}));
}

}  // namespace
}  // namespace dance

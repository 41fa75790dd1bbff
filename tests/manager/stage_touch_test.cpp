// Hold-hands as a word of a route, and the touches that a manager says.
#include <gtest/gtest.h>

#include "core/net/mono_clock.h"
#include "manager/manager.h"
#include "tests/allocation_guard.h"
#include "tests/core/bus/port_double.h"
#include "tests/manager/router_stage.h"
#include "tests/transformers/touch/two_dancers.h"

namespace dance {
namespace {

using Eigen::Vector3f;

Pose numbered(Pose pose, std::uint32_t sequence, MonoTime capture) {
  pose.sequence = sequence;
  pose.capture_time = capture;
  pose.clock_id = kClock;
  return pose;
}

std::vector<Route> holding(bool lead_too) {
  Route lead = pass_through(Where::kCapture), follow = held("predict");
  follow.through = {"predict", "hold-hands"};
  if (lead_too) lead.through = {"hold-hands"};
  return {lead, follow};
}

// A dancer here and one from elsewhere, whose palms stay 6 cm apart.
float gap_on_stage(const std::vector<Route>& routes) {
  Stage stage;
  Router router(routes, kClock, stage);
  for (std::uint32_t i = 0; i < 90; ++i) {
    const MonoTime now = at_ms(1000.0 + 16.0 * i);
    const Vector3f apart(0.0f, i < 5 ? 0.0f : 0.06f, 0.0f);
    router.take(Where::kCapture, guest("lead"),
                numbered(with_palm_at(lead_pose(), 0, meeting_place()), i, now), now);
    router.take(Where::kGuest, guest("follow"),
                numbered(with_palm_at(follow_pose(), 1, meeting_place() + apart), i, now), now);
    router.tick(1, now);
  }
  Pose lead, follow;
  for (const auto& [name, pose] : stage.poses) (name == guest("lead") ? lead : follow) = pose;
  return (palm_in(lead, 0) - palm_in(follow, 1)).norm();
}

TEST(HoldHands, ClosesTheGapFromOneSideOrFromBoth) {
  std::vector<Route> plain = holding(false);
  plain[1].through = {"predict"};
  EXPECT_GT(gap_on_stage(plain), 0.05f);
  EXPECT_LT(gap_on_stage(holding(false)), 0.01f);
  EXPECT_LT(gap_on_stage(holding(true)), 0.01f);
}

TEST(HoldHands, LeavesPosesThatAreHandedOnWithoutAnAllocation) {
  Stage stage;
  stage.keep = false;
  Route lead = pass_through(Where::kCapture);
  lead.through = {"hold-hands"};
  Router router({lead}, kClock, stage);
  const Pose a = with_palm_at(lead_pose(), 0, meeting_place()),
             b = with_palm_at(follow_pose(), 1, meeting_place());
  for (const char* name : {"a", "b"}) router.take(Where::kCapture, guest(name), a, at_ms(1));
  const GuestId one = guest("a"), two = guest("b");
  const AllocationGuard guard;
  for (std::uint32_t i = 1; i < 50; ++i) {
    const MonoTime now = at_ms(16.0 * i);
    router.take(Where::kCapture, one, numbered(a, i, now), now);
    router.take(Where::kCapture, two, numbered(b, i, now), now);
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(stage.count, 100);
  EXPECT_TRUE(router.holds().are_held(one, 0, two, 1));
}

TEST(HoldHands, AManagerSaysWhoTouchesWhomToBoth) {
  PortDouble port;
  const auto poller = *Poller::create();
  Route route = pass_through(Where::kCapture);
  Manager manager({route}, port, *poller);
  std::vector<Touch> alice, bob;
  port.subscribe<Touch>({Where::kStage, guest("alice")},
                        [&](const Channel&, const Touch& t, MonoTime) { alice.push_back(t); });
  port.subscribe<Touch>({Where::kStage, guest("bob")},
                        [&](const Channel&, const Touch& t, MonoTime) { bob.push_back(t); });
  for (std::uint32_t i = 0; i < 300 && (alice.size() < 4 || bob.size() < 4); ++i) {
    const MonoTime now = mono_now();
    port.publish(Where::kCapture, guest("alice"),
                 numbered(with_palm_at(lead_pose(), 0, meeting_place()), i, now));
    port.publish(Where::kCapture, guest("bob"),
                 numbered(with_palm_at(follow_pose(), 1, meeting_place()), i, now));
    poller->run_once(Duration::ms(20));
  }
  ASSERT_GE(alice.size(), 4u);
  ASSERT_GE(bob.size(), 4u);
  const auto is_hold = [](const Touch& touch) { return touch.is_hold; };
  EXPECT_TRUE(std::any_of(alice.begin(), alice.end(), is_hold));
  EXPECT_TRUE(std::any_of(bob.begin(), bob.end(), is_hold));
  EXPECT_EQ(alice[0].other, guest("bob"));
  EXPECT_EQ(alice[0].clock_id, this_clock_id());
}

TEST(HoldHands, AManagerTellsOnlyTheDancersOfItsHouse) {
  PortDouble port;
  const auto poller = *Poller::create();
  Manager manager({pass_through(Where::kCapture), pass_through(Where::kGuest)}, port, *poller);
  std::size_t alice = 0, bob = 0;
  port.subscribe<Touch>({Where::kStage, guest("alice")},
                        [&](const Channel&, const Touch&, MonoTime) { ++alice; });
  port.subscribe<Touch>({Where::kStage, guest("bob")},
                        [&](const Channel&, const Touch&, MonoTime) { ++bob; });
  for (std::uint32_t i = 0; i < 300 && alice < 4; ++i) {
    const MonoTime now = mono_now();
    port.publish(Where::kCapture, guest("alice"),
                 numbered(with_palm_at(lead_pose(), 0, meeting_place()), i, now));
    port.publish(Where::kGuest, guest("bob"),
                 numbered(with_palm_at(follow_pose(), 1, meeting_place()), i, now));
    poller->run_once(Duration::ms(20));
  }
  EXPECT_GE(alice, 4u);
  EXPECT_EQ(bob, 0u);
  EXPECT_EQ(manager.without_touch(), 0u);
}

}  // namespace
}  // namespace dance

#include "manager/router.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/allocation_guard.h"
#include "tests/manager/router_stage.h"

namespace dance {
namespace {

TEST(Router, PassesACaptureToTheStageAtOnceAndUnchanged) {
  Stage stage;
  Router router({pass_through(Where::kCapture)}, kClock, stage);
  router.take(Where::kCapture, guest("alice"), pose_of(41, at_ms(10)), at_ms(11));
  ASSERT_EQ(stage.poses.size(), 1u);
  EXPECT_EQ(stage.poses[0].first, guest("alice"));
  EXPECT_EQ(stage.poses[0].second.sequence, 41u);
  EXPECT_EQ(stage.poses[0].second.capture_time, at_ms(10));
  EXPECT_EQ(stage.poses[0].second.stamped(Hop::kStageTaken), at_ms(11));
}

TEST(Router, SendsEachGuestOnTheRoutesThatAreMeant) {
  Stage stage;
  Router router({pass_through(Where::kCapture, "alice", "mirror"), pass_through(Where::kGuest)},
                kClock, stage);
  router.take(Where::kCapture, guest("alice"), pose_of(0, at_ms(1)), at_ms(1));
  router.take(Where::kCapture, guest("carol"), pose_of(0, at_ms(1)), at_ms(1));  // no route
  router.take(Where::kGuest, guest("bob"), pose_of(0, at_ms(1)), at_ms(1));
  ASSERT_EQ(stage.poses.size(), 2u);
  EXPECT_EQ(stage.poses[0].first, guest("mirror"));
  EXPECT_EQ(stage.poses[1].first, guest("bob"));
  EXPECT_EQ(router.stats().dropped_unrouted, 1);
  EXPECT_EQ(router.stats().forwarded, 2);
  EXPECT_EQ(router.stats().received, 3);
}

TEST(Router, ShowsFingersWithTheBodyOfTheirMoment) {
  Stage stage;
  Router router({held("hold 100ms")}, kClock, stage);
  for (int i = 0; i < 120; ++i) {
    const MonoTime capture = at_ms(1000.0 + 16.0 * i), arrival = capture + Duration::ms(30);
    router.take(Where::kGuest, guest("bob"), pose_of(static_cast<std::uint32_t>(i), capture),
                arrival);
    Hands hands;
    hands.sequence = static_cast<std::uint32_t>(i);
    hands.capture_time = capture;
    hands.clock_id = kClock;
    router.take(Where::kGuest, guest("bob"), hands);
    router.tick(0, arrival + Duration::ms(4));
    if (stage.fingers.empty() || stage.poses.empty()) continue;
    const Duration apart =
        stage.poses.back().second.capture_time - stage.fingers.back().capture_time;
    EXPECT_GE(apart, Duration());
    EXPECT_LE(apart, Duration::ms(16)) << i;
  }
  EXPECT_GT(stage.fingers.size(), 100u);
}

TEST(Router, SetsTheFlowOfAGuestAndOfThoseWhoComeLater) {
  Stage stage;
  Router router({pass_through(Where::kCapture), held("hold 100ms")}, kClock, stage);
  router.take(Where::kGuest, guest("bob"), pose_of(0, at_ms(1000)), at_ms(1030));
  FlowSetting wanted;
  wanted.hold_ms = 20.0f;
  wanted.on[index_of(FlowWord::kHold)] = false;
  router.set(guest("bob"), wanted);
  router.set(guest("cara"), wanted);
  FlowSetting wrong = wanted;
  wrong.lead = 9.0f;
  router.set(guest("bob"), wrong);
  router.take(Where::kGuest, guest("cara"), pose_of(0, at_ms(1000)), at_ms(1031));
  router.take(Where::kGuest, guest("dora"), pose_of(0, at_ms(1000)), at_ms(1031));
  router.take(Where::kCapture, guest("alice"), pose_of(0, at_ms(1000)), at_ms(1031));
  Style style;
  style.gain[0] = 1.5f;
  router.take(Where::kCapture, guest("alice"), style);
  std::map<std::string, FlowSetting> told;
  const auto tell = [&](const GuestId& id, const FlowSetting& setting) {
    told[std::string(id.view())] = setting;
  };
  router.tell_settings(at_ms(1040), tell);
  ASSERT_EQ(told.size(), 4u);
  for (const char* name : {"bob", "cara"}) {
    EXPECT_EQ(told[name].hold_ms, 20.0f) << name;
    EXPECT_FALSE(told[name].is_on(FlowWord::kHold)) << name;
    EXPECT_EQ(told[name].route, 1) << name;
    EXPECT_FALSE(told[name].own) << name;
  }
  EXPECT_EQ(told["dora"].hold_ms, 100.0f);
  EXPECT_TRUE(told["dora"].is_on(FlowWord::kHold));
  EXPECT_TRUE(told["alice"].own);
  EXPECT_EQ(told["alice"].guest_gain[0], 1.5f);
  EXPECT_FALSE(told["alice"].has_word(FlowWord::kHold)) << "a route without transformers";
  told.clear();
  router.tell_settings(at_ms(90'000), tell);
  EXPECT_TRUE(told.empty()) << "nobody is on the stage any more";
}

TEST(HandsQueue, IsBoundedAndBeginsAnewWithTheSource) {
  HandsQueue queue;
  Hands hands;
  for (int i = 0; i < 1000; ++i) {
    hands.capture_time = at_ms(1000.0 + i);
    hands.sequence = static_cast<std::uint32_t>(i);
    queue.push(hands);
    queue.push(hands);  // a copy is dropped
  }
  EXPECT_EQ(queue.take_due(at_ms(1000.0), 0), nullptr) << "the oldest have given way";
  const Hands* due = queue.take_due(at_ms(1990.5), 0);
  ASSERT_NE(due, nullptr);
  EXPECT_EQ(due->sequence, 990u);
  EXPECT_EQ(queue.take_due(at_ms(1990.5), 0), nullptr);
  hands.capture_time = at_ms(10.0);
  hands.sequence = 5000;
  queue.push(hands);
  due = queue.take_due(at_ms(11.0), 0);
  ASSERT_NE(due, nullptr);
  EXPECT_EQ(due->sequence, 5000u);
  hands.capture_time = at_ms(90'000.0);
  hands.clock_id = 77;
  queue.push(hands);
  EXPECT_NE(queue.take_due(at_ms(11.0), 0), nullptr) << "clocks that cannot be compared";
}

TEST(Router, GivesHandsAndSkeletonsOnWithThePoses) {
  Stage stage;
  Router router({pass_through(Where::kGuest)}, kClock, stage);
  router.take(Where::kGuest, guest("bob"), pose_of(1, at_ms(1)), at_ms(1));
  router.take(Where::kGuest, guest("bob"), Hands());
  router.take(Where::kGuest, guest("bob"), TimedSkeleton());
  router.take(Where::kCapture, guest("alice"), TimedSkeleton());  // no route from there
  EXPECT_EQ(stage.hands, std::vector{guest("bob")});
  EXPECT_EQ(stage.skeletons, std::vector{guest("bob")});
}

TEST(Router, StagesHeldGuestsAtASteadyRateWhateverArrives) {
  Stage stage;
  Router router({held("hold 20ms")}, kClock, stage);
  double next_ms = 100.0;
  for (int i = 0; i < 300; ++i) {
    const double capture_ms = 1000.0 / 60.0 * i;
    const double arrival_ms = capture_ms + 30.0 + (i % 5) * 3.0;
    for (; next_ms < arrival_ms; next_ms += 1000.0 / 60.0) router.tick(0, at_ms(next_ms));
    router.take(Where::kGuest, guest("bob"),
                pose_of(static_cast<std::uint32_t>(i), at_ms(capture_ms)), at_ms(arrival_ms));
  }
  ASSERT_GT(stage.poses.size(), 250u);
  for (std::size_t i = 100; i < stage.poses.size(); ++i) {
    EXPECT_EQ(stage.poses[i].second.sequence, stage.poses[i - 1].second.sequence + 1);
    const double step_ms =
        (stage.poses[i].second.capture_time - stage.poses[i - 1].second.capture_time).as_ms();
    EXPECT_NEAR(step_ms, 1000.0 / 60.0, 1.0);
  }
}

TEST(Router, DoesNotHoldASilentGuestOnTheStageForEver) {
  Stage stage;
  Router router({held("hold 0ms")}, kClock, stage);
  router.take(Where::kGuest, guest("bob"), pose_of(0, at_ms(0)), at_ms(10));
  router.tick(0, at_ms(500));
  EXPECT_EQ(stage.count, 1);
  router.tick(0, at_ms(2500));
  EXPECT_EQ(stage.count, 1);
  router.take(Where::kGuest, guest("bob"), pose_of(1, at_ms(2600)), at_ms(2610));
  router.tick(0, at_ms(2620));
  EXPECT_EQ(stage.count, 2);
}

TEST(Router, ShowsASilentGuestForAsLongAsTheFlowGoesOnWithTheDance) {
  Stage stage;
  Route route = held("hold 0ms");
  route.through.push_back("bridge");
  Router router({route}, kClock, stage);
  for (std::uint32_t i = 0; i < 600; ++i) {
    const MonoTime capture = at_ms(1000.0 + 1000.0 / 60.0 * i);
    router.take(Where::kGuest, guest("bob"), pose_of(0, capture), capture + Duration::ms(10));
  }
  const double last_ms = 1000.0 + 1000.0 / 60.0 * 599 + 10.0;
  for (const double silent_ms : {500.0, 2500.0, 5000.0, 9900.0}) {
    const int before = stage.count;
    router.tick(0, at_ms(last_ms + silent_ms));
    EXPECT_EQ(stage.count, before + 1) << silent_ms;
  }
  const int before = stage.count;
  router.tick(0, at_ms(last_ms + 10'100.0));
  EXPECT_EQ(stage.count, before) << "who is not there leaves the stage";
  router.take(Where::kGuest, guest("bob"), pose_of(0, at_ms(last_ms + 12'000.0)),
              at_ms(last_ms + 12'010.0));
  router.tick(0, at_ms(last_ms + 12'012.0));
  EXPECT_EQ(stage.count, before + 1);
}

TEST(Router, KeepsThirtyGuestsApart) {
  Stage stage;
  Router router({held("hold 0ms")}, kClock, stage);
  for (std::uint32_t i = 0; i < 30; ++i)
    router.take(Where::kGuest, guest("g" + std::to_string(i)), pose_of(i, at_ms(100)), at_ms(101));
  router.tick(0, at_ms(102));
  ASSERT_EQ(stage.poses.size(), 30u);
  for (std::uint32_t i = 0; i < 30; ++i) {
    EXPECT_EQ(stage.poses[i].first, guest("g" + std::to_string(i)));
    EXPECT_FLOAT_EQ(stage.poses[i].second.p_WH_m.x(), static_cast<float>(i));
  }
}

TEST(Router, BoundsItsGuestsAndCountsWhomItTurnsAway) {
  Stage stage;
  Router router({held("hold 0ms")}, kClock, stage);
  for (std::size_t i = 0; i < kMaxGuests + 5; ++i)
    router.take(Where::kGuest, guest("g" + std::to_string(i)), pose_of(0, at_ms(100)), at_ms(101));
  EXPECT_EQ(router.stats().dropped_overflow, 5);
  router.tick(0, at_ms(102));
  EXPECT_EQ(stage.poses.size(), kMaxGuests);
}

// A router whose dancers are learned; with a flow its learner goes.
struct LearnedGuests {
  LearnedGuests() {
    router.on_learner(
        [this](const std::shared_ptr<Learner>& learner) { learners.emplace_back(learner); });
  }
  static Route predicted() {
    Route route = held("hold 0ms");
    route.through.push_back("predict");
    return route;
  }
  void hear(const std::string& name, double ms) {
    router.take(Where::kGuest, guest(name), pose_of(0, at_ms(ms)), at_ms(ms));
  }
  std::ptrdiff_t kept() const {
    return std::count_if(learners.begin(), learners.end(),
                         [](const auto& learner) { return !learner.expired(); });
  }

  Stage stage;
  Router router{{predicted()}, kClock, stage};
  std::vector<std::weak_ptr<Learner>> learners;
};

TEST(Router, KeepsWhatWasLearnedOfWhoComesRightBack) {
  LearnedGuests house;
  house.hear("bob", 0.0);
  for (double s = 1.0; s < 299.0; s += 1.0) house.router.evict_gone(at_ms(1e3 * s));
  house.hear("bob", 299e3);
  for (double s = 299.0; s < 598.0; s += 1.0) house.router.evict_gone(at_ms(1e3 * s));
  house.hear("bob", 598e3);
  EXPECT_EQ(house.learners.size(), 1u) << "one flow all the time";
  EXPECT_EQ(house.kept(), 1);
}

TEST(Router, FreesTheFlowOfWhoHasGoneForLong) {
  LearnedGuests house;
  house.hear("bob", 0.0);
  house.hear("carol", 0.0);
  house.hear("carol", 200e3);
  house.router.evict_gone(at_ms(299e3));
  EXPECT_EQ(house.kept(), 2);
  house.router.evict_gone(at_ms(301e3));
  EXPECT_EQ(house.kept(), 1);
  EXPECT_TRUE(house.learners[0].expired());
  house.router.tick(0, at_ms(302e3));
  house.hear("bob", 303e3);
  EXPECT_EQ(house.learners.size(), 3u) << "begins anew";
  house.router.tick(0, at_ms(303e3));
  EXPECT_EQ(house.stage.poses.back().first, guest("bob"));
}

TEST(Router, OfAFullStageWhoIsSilentForLongestGivesTheirPlace) {
  LearnedGuests house;
  for (std::size_t i = 0; i < kMaxGuests; ++i) house.hear("g" + std::to_string(i), 10.0);
  for (std::size_t i = 0; i < kMaxGuests; ++i)
    if (i != 5) house.hear("g" + std::to_string(i), 1000.0 + static_cast<double>(i));
  house.router.roster().end_second(at_ms(100e3), kClock, [](const auto&, const auto&) {});
  house.hear("newcomer", 100e3);
  for (std::size_t i = 0; i < kMaxGuests; ++i) EXPECT_EQ(house.learners[i].expired(), i == 5) << i;
}

TEST(Router, OfManyWhoHaveGoneKeepsTheLast) {
  LearnedGuests house;
  for (int i = 0; i < 30; ++i) house.hear("g" + std::to_string(i), 1000.0 * i);
  const auto g29_dances_on = [&](double from_s, double to_s) {
    for (double s = from_s; s < to_s; s += 1.0) {
      house.hear("g29", 1e3 * s);
      house.router.evict_gone(at_ms(1e3 * s));
    }
  };
  g29_dances_on(30.0, 68.5);
  EXPECT_EQ(house.kept(), 30) << "eight have been away for more than a minute";
  g29_dances_on(68.5, 69.5);
  EXPECT_EQ(house.kept(), 29) << "the ninth has";
  g29_dances_on(69.5, 120.0);
  EXPECT_EQ(house.kept(), static_cast<std::ptrdiff_t>(Router::kMostAway) + 1);
  for (std::size_t i = 0; i < 30; ++i) EXPECT_EQ(house.learners[i].expired(), i < 21) << i;
}

TEST(Router, ALineThatIsAwayForMinutesCostsNobodyWhatWasLearned) {
  LearnedGuests house;
  for (int i = 0; i < 30; ++i) house.hear("g" + std::to_string(i), 10.0 * i);
  for (double s = 1.0; s < 280.0; s += 1.0) house.router.evict_gone(at_ms(1e3 * s));
  for (int i = 0; i < 30; ++i) {
    house.hear("g" + std::to_string(i), 280e3 + 10.0 * i);
    house.router.evict_gone(at_ms(280e3 + 10.0 * i));
  }
  EXPECT_EQ(house.learners.size(), 30u) << "no flow was made anew";
}

TEST(Router, WhatAFlowHasRefusedIsCountedWhenItHasGone) {
  Stage stage;
  Router router({held("hold 0ms")}, kClock, stage);
  for (int i = 0; i < 3; ++i)
    router.take(Where::kGuest, guest("bob"), pose_of(0, at_ms(100)), at_ms(101));
  EXPECT_EQ(router.stats().dropped_late, 2);
  router.evict_gone(at_ms(400e3));
  EXPECT_EQ(router.stats().dropped_late, 2);
  router.take(Where::kGuest, guest("bob"), pose_of(0, at_ms(100)), at_ms(400e3));
  router.take(Where::kGuest, guest("bob"), pose_of(0, at_ms(100)), at_ms(400e3));
  EXPECT_EQ(router.stats().dropped_late, 3);
}

TEST(Router, AllocatesNothingPerPoseOnceAGuestIsKnown) {
  Stage stage;
  stage.keep = false;
  Router router({pass_through(Where::kCapture), held("hold 20ms")}, kClock, stage);
  router.take(Where::kCapture, guest("alice"), pose_of(0, at_ms(0)), at_ms(1));
  router.take(Where::kGuest, guest("bob"), pose_of(0, at_ms(0)), at_ms(1));
  const GuestId alice = guest("alice"), bob = guest("bob");
  AllocationGuard guard;
  for (std::uint32_t i = 1; i < 1000; ++i) {
    router.take(Where::kCapture, alice, pose_of(i, at_ms(16.0 * i)), at_ms(16.0 * i + 1));
    router.take(Where::kGuest, bob, pose_of(i, at_ms(16.0 * i)), at_ms(16.0 * i + 1));
    router.tick(1, at_ms(16.0 * i + 2));
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_GT(stage.count, 1900);
}

}  // namespace
}  // namespace dance

// A remote dancer on the stage of a house where the partner dances.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/allocation_guard.h"
#include "tests/transformers/partner/salsa_couple.h"
#include "transformers/flow.h"

namespace dance {
namespace {

constexpr std::size_t kFrames = 1200, kWarmUp = 600;
constexpr std::size_t kDelay = 12;  // frames: 200 ms

struct Shown {
  std::vector<Pose> poses;  // from kWarmUp on
  double palms_m = 0.0;     // mean distance of palms from where they were danced
  double furthest_step_m = 0.0;
  std::uint64_t allocations = 0;
};

struct Stage {
  std::vector<std::string> words{"predict"};
  std::size_t leaves = kFrames;  // when the partner is not seen any more
  std::size_t comes = 0;         // and when the partner is
  bool is_with_dancers = true;
  std::uint64_t partner_clock = 1;
  std::size_t hole_from = kFrames, hole_to = kFrames;  // poses of the partner that are missing
};

// The follow comes over a line of 200 ms; `here` dances in the house.
Shown show(const std::vector<Pose>& remote, const std::vector<Pose>& here, const Stage& stage) {
  const Skeleton follow = salsa_skeleton(SalsaRole::kFollow, 1);
  PartnerTracks dancers;
  const Skeleton lead = salsa_skeleton(SalsaRole::kLead, 1);
  auto flow = Flow::make(stage.words);
  EXPECT_TRUE(flow.has_value());
  flow->set_body(follow);
  if (stage.is_with_dancers) flow->set_dancers(&dancers);
  Shown shown;
  Palms before{};
  for (std::size_t i = 0; i < kFrames; ++i) {
    const MonoTime now = couple_time(i);
    if (i == 0 && stage.comes == 0) dancers.take(kHere, here[0], &lead);  // allocates
    const AllocationGuard guard;
    if (i > 0 && i >= stage.comes && i < stage.leaves &&
        (i < stage.hole_from || i >= stage.hole_to)) {
      Pose pose = here[i];
      pose.clock_id = stage.partner_clock;
      dancers.take(kHere, pose, &lead);
    }
    if (i >= kDelay) flow->observe(remote[i - kDelay], now);
    Pose pose;
    const bool is_shown = flow->sample(now, pose);
    if (i != stage.comes) shown.allocations += guard.allocations();
    if (!is_shown || i < kWarmUp) continue;
    const Palms is = palms_of(follow, pose), should = palms_of(follow, remote[i]);
    for (std::size_t side = 0; side < 2; ++side) {
      shown.palms_m += static_cast<double>((is[side] - should[side]).norm());
      if (!shown.poses.empty())
        shown.furthest_step_m =
            std::max(shown.furthest_step_m, static_cast<double>((is[side] - before[side]).norm()));
    }
    before = is;
    shown.poses.push_back(pose);
  }
  shown.palms_m /= 2.0 * static_cast<double>(shown.poses.size());
  return shown;
}

class PartnerFlow : public ::testing::Test {
 protected:
  const std::vector<Pose> follow_ = salsa_of(SalsaRole::kFollow, kFrames);
  const std::vector<Pose> lead_ = salsa_of(SalsaRole::kLead, kFrames);
};

bool are_equal(const Shown& a, const Shown& b) {
  if (a.poses.size() != b.poses.size()) return false;
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    if (a.poses[i].p_WH_m != b.poses[i].p_WH_m) return false;
    for (std::size_t bone = 0; bone < kBoneCount; ++bone)
      if (!(a.poses[i].R_PB[bone].coeffs() == b.poses[i].R_PB[bone].coeffs())) return false;
  }
  return true;
}

TEST_F(PartnerFlow, PalmsAreNearerToWhereTheyAreDancedBesideThePartner) {
  const Shown alone = show(follow_, lead_, {.is_with_dancers = false});
  const Shown beside = show(follow_, lead_, {});
  EXPECT_LT(beside.palms_m, 0.85 * alone.palms_m);
  EXPECT_LT(beside.furthest_step_m, 1.2 * alone.furthest_step_m);
  EXPECT_EQ(beside.allocations, 0u);
}

TEST_F(PartnerFlow, IsSwitchedOffByItsSetting) {
  const Shown alone = show(follow_, lead_, {.is_with_dancers = false});
  EXPECT_TRUE(are_equal(alone, show(follow_, lead_, {.words = {"predict partner=0"}})));
  EXPECT_FALSE(are_equal(alone, show(follow_, lead_, {.words = {"predict partner=1"}})));
  EXPECT_FALSE(Flow::make({"predict partner=perhaps"}).has_value());
}

TEST_F(PartnerFlow, ADancerOfAnotherDanceBringsNothing) {
  const Shown alone = show(follow_, lead_, {.is_with_dancers = false});
  const Shown stranger = show(follow_, salsa_of(SalsaRole::kLead, kFrames, 7), {});
  EXPECT_LT(stranger.palms_m, 1.03 * alone.palms_m);
}

TEST_F(PartnerFlow, ADancerOfAnotherClockIsNoPartner) {
  EXPECT_TRUE(are_equal(show(follow_, lead_, {.is_with_dancers = false}),
                        show(follow_, lead_, {.partner_clock = 9})));
}

TEST_F(PartnerFlow, APartnerWhoComesOrIsLostMakesNoJump) {
  const Shown alone = show(follow_, lead_, {.is_with_dancers = false});
  for (const Stage& stage :
       {Stage{.leaves = 900}, Stage{.comes = 800}, Stage{.hole_from = 900, .hole_to = 918}}) {
    const Shown shown = show(follow_, lead_, stage);
    EXPECT_LT(shown.furthest_step_m, 1.25 * alone.furthest_step_m) << stage.leaves;
    EXPECT_LT(shown.palms_m, 1.02 * alone.palms_m);
  }
}

TEST_F(PartnerFlow, WhatWasDancedIsShownAsDanced) {
  // Nothing is predicted of a moment that has come.
  const Shown held = show(follow_, lead_, {.words = {"hold 500ms", "predict"}});
  const Shown alone =
      show(follow_, lead_, {.words = {"hold 500ms", "predict"}, .is_with_dancers = false});
  EXPECT_TRUE(are_equal(held, alone));
}

}  // namespace
}  // namespace dance

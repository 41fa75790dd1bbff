#include "tunnel/server/pace/share_plan.h"

#include <gtest/gtest.h>

#include <vector>

#include "tunnel/server/pace/pose_flow.h"

namespace dance {
namespace {

std::vector<WantedFlow> crowd(std::size_t guests) {
  return std::vector<WantedFlow>(guests, WantedFlow{60.0, 60.0 * 36.0, 1});
}

TEST(SharePlan, TheRampThinsOutTheLeastImportantFirst) {
  constexpr std::size_t kGuests = 5;
  const auto all = [&](std::size_t ramp) {
    std::vector<int> dividers;
    for (std::size_t i = 0; i < kGuests; ++i) dividers.push_back(ramp_divider(i, kGuests, ramp));
    return dividers;
  };
  EXPECT_EQ(all(0), (std::vector<int>{1, 1, 1, 1, 1}));
  EXPECT_EQ(all(1), (std::vector<int>{1, 1, 1, 1, 2}));
  EXPECT_EQ(all(2), (std::vector<int>{1, 1, 1, 2, 4}));
  EXPECT_EQ(all(4), (std::vector<int>{1, 2, 4, 8, 8}));
  EXPECT_EQ(all(longest_ramp(kGuests)), (std::vector<int>{8, 8, 8, 8, 8}));
  EXPECT_NE(all(longest_ramp(kGuests) - 1), all(longest_ramp(kGuests)));
  EXPECT_EQ(longest_ramp(0), 0u);
}

TEST(SharePlan, WaitsNoLongerThanTheBudgetAsksFor) {
  const auto flows = crowd(29);
  const double at_once = share_cost(flows, 0, Duration());
  EXPECT_EQ(share_window_for(flows, 0, at_once), Duration());
  EXPECT_EQ(share_window_for(flows, 0, 2.0 * at_once), Duration());
  const double least = share_cost(flows, 0, kLongestShareWindow);
  EXPECT_LT(least, 0.6 * at_once);
  for (const double share : {0.9, 0.5, 0.1}) {
    const double budget = least + share * (at_once - least);
    const Duration window = share_window_for(flows, 0, budget);
    EXPECT_GT(window, Duration());
    EXPECT_LE(window, kLongestShareWindow);
    EXPECT_NEAR(share_cost(flows, 0, window), budget, 1.0);
    EXPECT_EQ(ramp_for(flows, budget), 0u) << "nobody is thinned out where waiting does";
  }
  EXPECT_GT(share_window_for(flows, 0, 0.5 * least), kLongestShareWindow);
}

TEST(SharePlan, ThinsOutAsLittleAsTheBudgetAsksFor) {
  const auto flows = crowd(29);
  const double least = share_cost(flows, 0, kLongestShareWindow);
  std::size_t before = 0;
  for (double budget = least; budget > 0.2 * least; budget *= 0.95) {
    const std::size_t ramp = ramp_for(flows, budget);
    EXPECT_GE(ramp, before);
    before = ramp;
    if (ramp == longest_ramp(flows.size())) continue;
    EXPECT_LE(share_cost(flows, ramp, kLongestShareWindow), budget);
    if (ramp == 0) continue;
    EXPECT_GT(share_cost(flows, ramp - 1, kLongestShareWindow), budget);
  }
  EXPECT_GT(before, 10u);
  EXPECT_EQ(ramp_for(flows, 0.0), longest_ramp(flows.size()));
}

TEST(SharePlan, WhatIsWantedSeldomCostsLittle) {
  auto flows = crowd(10);
  const double all = share_cost(flows, 0, Duration());
  for (WantedFlow& flow : flows) flow.divider = 4;
  EXPECT_LT(share_cost(flows, 0, Duration()), 0.4 * all);
  // A ramp gives nobody more than is wanted.
  EXPECT_LE(share_cost(flows, 5, Duration()), share_cost(flows, 0, Duration()));
}

TEST(SharePlan, NothingCostsNothing) {
  const std::vector<WantedFlow> none, silent(4);
  for (const auto& flows : {none, silent}) {
    EXPECT_EQ(share_cost(flows, 0, Duration()), 0.0);
    EXPECT_EQ(ramp_for(flows, 0.0), 0u);
    EXPECT_EQ(share_window_for(flows, 0, 0.0), Duration());
    EXPECT_EQ(share_window_for_company(flows, 0, 3.0), Duration());
  }
}

TEST(SharePlan, CompanyComesInTheWaitThatItTakes) {
  const auto flows = crowd(50);  // 3000 poses a second
  EXPECT_EQ(share_window_for_company(flows, 0, 0.5), Duration());
  EXPECT_EQ(share_window_for_company(flows, 0, 4.0), Duration::ms(1));
  EXPECT_EQ(share_window_for_company(flows, 0, 400.0), kLongestShareWindow);
}

TEST(PoseFlow, FollowsWhatAGuestSends) {
  PoseFlow flow;
  flow.sample(0.5);
  EXPECT_EQ(flow.poses_per_s(), 0.0);
  for (int half = 0; half < 2; ++half) {
    for (int i = 0; i < 30; ++i) flow.add(40);
    flow.sample(0.5);
    EXPECT_DOUBLE_EQ(flow.poses_per_s(), 60.0);
    EXPECT_DOUBLE_EQ(flow.bytes_per_s(), 2400.0);
  }
  for (int i = 0; i < 12; ++i) flow.sample(0.5);
  EXPECT_LT(flow.poses_per_s(), 0.1);
}

}  // namespace
}  // namespace dance

#include "research/capture/stereo_eval.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace dance {
namespace {

TEST(StereoEval, TellsTheDistanceBetterThanOneEyeOrTwoNetworks) {
  const StereoEval eval = evaluate_stereo({"usual", 3.0, 25.0, 1.75}, {18, 9, 3});
  EXPECT_EQ(eval.hinted, eval.frames);
  std::fputs(stereo_eval_table({eval}).c_str(), stdout);
  const auto mean = [&](DepthWay way) {
    return eval.errors[static_cast<std::size_t>(way)].mean_mm;
  };
  EXPECT_LT(mean(DepthWay::kStereo), 35.0);
  EXPECT_LT(mean(DepthWay::kStereo), 0.5 * mean(DepthWay::kOneEye));
  EXPECT_LT(mean(DepthWay::kStereo), 0.7 * mean(DepthWay::kTwoNetworks));
  EXPECT_LT(eval.errors[0].scale_mean_percent, 0.6 * eval.errors[1].scale_mean_percent);
  EXPECT_GE(eval.within_two_spreads, 0.75);
}

}  // namespace
}  // namespace dance

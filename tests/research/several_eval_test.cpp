#include "research/capture/several_eval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "producers/salsa/salsa_dancer.h"

namespace dance {
namespace {

// Two salsa dancers who go to and fro.
std::vector<CodecTake> salsa_takes(double seconds) {
  constexpr double kHz = 60.0;
  std::vector<CodecTake> takes;
  for (const std::uint64_t seed : {3u, 4u}) {
    SalsaStyle style;
    style.seed = seed;
    SalsaDancer dancer{style};
    CodecTake take{"salsa", dancer.skeleton(), kHz, {}};
    take.poses.resize(static_cast<std::size_t>(seconds * kHz));
    for (std::size_t i = 0; i < take.poses.size(); ++i) {
      const double t_s = static_cast<double>(i) / kHz;
      dancer.dance_at(Duration::seconds(t_s), take.poses[i]);
      take.poses[i].p_WH_m.x() += static_cast<float>(0.8 * std::sin(0.9 * t_s));
      take.poses[i].p_WH_m.z() += static_cast<float>(0.6 * std::sin(1.3 * t_s));
    }
    takes.push_back(std::move(take));
  }
  return takes;
}

TEST(SeveralEval, TwoCamerasThatNobodyPlacedKnowDepthBetterThanOne) {
  const SeveralScore score = evaluate_several({"60 degrees apart", 60.0}, salsa_takes(16.0));
  std::fputs(several_table({score}).c_str(), stdout);
  ASSERT_EQ(score.placed, 2);
  const auto error = [&](SeenBy how) { return score.errors[static_cast<std::size_t>(how)]; };
  EXPECT_LT(4.0 * error(SeenBy::kTwoTold).hips_mm, error(SeenBy::kOne).hips_mm);
  EXPECT_LT(error(SeenBy::kTwoTold).hips_mm, error(SeenBy::kOneTold).hips_mm);
  EXPECT_LT(1.5 * error(SeenBy::kTwo).relative_mm, error(SeenBy::kOne).relative_mm);
  EXPECT_LT(score.later_error_ms, 4.0);
  EXPECT_LT(score.turn_error_deg, 3.0);
}

}  // namespace
}  // namespace dance

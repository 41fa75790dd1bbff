// Partner-aware prediction on real couples, with the built-in model; skipped where there are none
// beside the tree. Loose: what it can do is said by docs/prediction.md.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/motion/palm_pull.h"
#include "research/predict/couple_eval.h"
#include "tests/research/predict/real_takes.h"

namespace dance {
namespace {

constexpr std::size_t kCoupleFrames = 1000;
const std::vector<std::string> kCouples{"cmu_60_05_salsa", "cmu_61_05_salsa", "cmu_60_12_salsa",
                                        "cmu_61_12_salsa"};

TEST(PredictCoupleTakes, ThePartnersHandsImproveThePredictionOfHands) {
  auto takes = real_takes(kCouples, kCoupleFrames);
  if (takes.empty()) GTEST_SKIP() << "no real takes beside this tree";
  const auto couples = couples_of(std::move(takes));
  ASSERT_TRUE(couples.has_value());
  CoupleEvalOptions options;
  options.model = built_in_predict_model();
  options.horizons = {Duration::ms(120), Duration::ms(200)};
  options.noise_deg = 0.5;
  options.keeps_palms = true;
  const CoupleEval eval = evaluate_couples(*couples, options);
  EXPECT_GT(eval.coupled[1], 0.9);
  // What was kept is what the errors are of: weights that are fitted to it find palms again.
  const auto fitted = fit_palms(eval.palms);
  ASSERT_TRUE(fitted.has_value()) << fitted.error().what;
  double plain_m = 0.0, fitted_m = 0.0;
  for (const PalmMoment& palm : eval.palms) {
    if (!palm.is_held) continue;
    const PalmGuesses::Sum sum = palm.said.weighed(*fitted);
    plain_m += static_cast<double>(palm.missing_m.norm());
    fitted_m += static_cast<double>((sum.by_partner + sum.by_misses - palm.missing_m).norm());
  }
  EXPECT_LT(fitted_m, 0.75 * plain_m);
  for (const auto& e : eval.errors) {
    EXPECT_LT(e[1].body_m, e[0].body_m);
    EXPECT_LT(e[1].arms_m, 0.97 * e[0].arms_m);
    EXPECT_LT(e[1].hold_m, 0.85 * e[0].hold_m);
    // Nothing by a dancer of another dance, and no harm.
    EXPECT_LT(e[2].body_m, 1.02 * e[0].body_m);
    EXPECT_LT(e[2].world_m, 1.02 * e[0].world_m);
  }
}

TEST(PredictCoupleTakes, PalmsNearEachOtherAreBroughtTogether) {
  auto takes = real_takes({kCouples[0], kCouples[1]}, kCoupleFrames);
  if (takes.empty()) GTEST_SKIP() << "no real takes beside this tree";
  auto couples = couples_of(std::move(takes));
  ASSERT_TRUE(couples.has_value());
  CoupleTake joined = (*couples)[0];
  join_palms(joined, 0.4f);
  const auto nearest = [](const CoupleTake& couple, std::size_t i) {
    std::array<std::array<Eigen::Vector3f, 2>, 2> palms;
    for (std::size_t d = 0; d < 2; ++d) {
      BodyFrames frames;
      forward_kinematics(couple[d].skeleton, couple[d].poses[i], frames);
      for (std::size_t side = 0; side < 2; ++side)
        palms[d][side] = palm_of(couple[d].skeleton, frames, side);
    }
    float least = 1e9f;
    for (std::size_t k = 0; k < 4; ++k)
      least = std::min(least, (palms[0][k / 2] - palms[1][k % 2]).norm());
    return least;
  };
  double before = 0.0, after = 0.0;
  for (std::size_t i = 0; i < joined[0].poses.size(); i += 10) {
    before += static_cast<double>(nearest((*couples)[0], i));
    after += static_cast<double>(nearest(joined, i));
    for (std::size_t d = 0; d < 2; ++d) ASSERT_TRUE(is_valid(joined[d].poses[i]));
  }
  EXPECT_LT(after, 0.9 * before);
}

TEST(PredictCoupleTakes, FilesThatAreNoCouplesAreNamed) {
  PredictTake take;
  take.name = "one.bvh";
  take.poses.resize(100);
  EXPECT_FALSE(couples_of({take}).has_value());
  PredictTake shorter = take;
  shorter.name = "two.bvh";
  shorter.poses.resize(50);
  const auto couples = couples_of({take, shorter});
  ASSERT_FALSE(couples.has_value());
  EXPECT_NE(couples.error().what.find("two.bvh"), std::string::npos);
  shorter.poses.resize(95);
  ASSERT_TRUE(couples_of({take, shorter}).has_value());
  EXPECT_EQ((*couples_of({take, shorter}))[0][0].poses.size(), 95u);
}

}  // namespace
}  // namespace dance

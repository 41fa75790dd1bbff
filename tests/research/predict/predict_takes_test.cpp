// Prediction on real takes, with the built-in model; skipped where there are none beside the tree.
// Loose: what it can do is said by docs/prediction.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "research/predict/predict_eval.h"
#include "tests/research/predict/real_takes.h"

namespace dance {
namespace {

constexpr std::size_t kFrames = 1200;

TEST(PredictTakes, SalsaIsPredictedBetterThanAnyoneCould) {
  const auto takes = real_takes({"cmu_60_05_salsa", "cmu_61_12_salsa"}, kFrames);
  if (takes.empty()) GTEST_SKIP() << "no real takes beside this tree";
  PredictEvalOptions options;
  options.model = built_in_predict_model();
  options.horizons = {Duration::ms(100), Duration::ms(200), Duration::ms(400)};
  options.noise_deg = 0.5;
  for (const bool fresh : {false, true}) {
    options.fresh = fresh;
    const PredictEval eval = evaluate_prediction(takes, options);
    EXPECT_EQ(eval.frames, 2400u);
    for (std::size_t h = 0; h < options.horizons.size(); ++h) {
      const ForecastErrors& e = eval.mean_m[h];
      EXPECT_LT(e[0], (fresh ? 0.88 : 0.70) * std::min({e[1], e[2], e[3]})) << h << fresh;
      EXPECT_LT(eval.worst[h].ratio, 1.05) << h << fresh;
    }
  }
}

TEST(PredictTakes, TakesAreMirroredAsTheyShould) {
  const auto takes = real_takes({"cmu_60_05_salsa"}, kFrames);
  if (takes.empty()) GTEST_SKIP() << "no real takes beside this tree";
  const PredictTake twice = mirrored(mirrored(takes[0]));
  for (std::size_t i = 0; i < twice.poses.size(); i += 100)
    for (std::size_t b = 0; b < kBoneCount; ++b)
      ASSERT_LT(twice.poses[i].R_PB[b].angularDistance(takes[0].poses[i].R_PB[b]), 1e-3f);
}

TEST(PlainForecast, GoesOnAsItShould) {
  std::array<Pose, 8> poses;
  for (std::size_t i = 0; i < poses.size(); ++i)
    poses[i].R_PB[8] = Eigen::Quaternionf(
        Eigen::AngleAxisf(0.01f * static_cast<float>(i), Eigen::Vector3f::UnitX()));
  const auto angle = [&](Forecast forecast) {
    return plain_forecast(forecast, &poses[7], 60.0, 0.2).R_PB[8].angularDistance(poses[7].R_PB[8]);
  };
  EXPECT_NEAR(angle(Forecast::kZeroVelocity), 0.0f, 1e-4f);
  EXPECT_NEAR(angle(Forecast::kConstantVelocity), 0.12f, 1e-3f);
  EXPECT_NEAR(angle(Forecast::kDampedVelocity), 0.06f * (1.0f - std::exp(-2.0f)), 1e-3f);
  EXPECT_NEAR(angle(Forecast::kReferenceExtrapolator), 0.01f / 12.0f, 1e-3f);
}

}  // namespace
}  // namespace dance

// Prediction beside a sensor that loses limbs, and of dancers who spin.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/transformers/predicted_dances.h"
#include "transformers/predict/dance_predictor.h"

namespace dance {
namespace {

// A sensor turns a leg right round for two frames, every second: that makes little of what was
// learned of it wrong.
TEST(LostLimbs, ForgetsALimbThatASensorLostForAFrame) {
  const auto danced = salsa(2400);
  auto heard = danced;
  const std::size_t leg = index_of(Bone::kLeftUpperLeg);
  for (std::size_t i = 60; i < heard.size(); i += i % 60 == 0 ? 1 : 59)
    heard[i].R_PB[leg] = heard[i].R_PB[leg] * exp_rotation(Eigen::Vector3f(0.0f, 3.0f, 0.5f));
  constexpr std::size_t kAhead = 6;
  std::array<double, 2> sums{};
  for (std::size_t which = 0; which < 2; ++which) {
    DancePredictor predictor(built_in_predict_model());
    for (std::size_t i = 0; i + kAhead < danced.size(); ++i) {
      predictor.observe(which == 0 ? danced[i] : heard[i]);
      // A third of a second after it.
      if (i < 600 || i % 60 < 20) continue;
      Pose out;
      predictor.predict(danced[i].capture_time + Duration::ms(100), out);
      sums[which] +=
          static_cast<double>(out.R_PB[leg].angularDistance(danced[i + kAhead].R_PB[leg]));
    }
  }
  EXPECT_LT(sums[1], 1.2 * sums[0]);
}

float furthest_off(const DancePredictor& predictor, const Pose& truth) {
  Pose shown;
  predictor.predict(truth.capture_time, shown);
  float most = 0.0f;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    most = std::max(most, shown.R_PB[b].angularDistance(truth.R_PB[b]));
  return most;
}

TEST(LostLimbs, BelievesAtOnceWhereABoneIsThatWasNotSeen) {
  const std::size_t arm = index_of(Bone::kRightUpperArm);
  const auto elsewhere = exp_rotation(Eigen::Vector3f(0.0f, 0.0f, 1.5f));
  for (const std::size_t absent_from : {0u, 200u}) {
    DancePredictor predictor(built_in_predict_model());
    auto dance = salsa(300);
    for (std::size_t i = 0; i < dance.size(); ++i) {
      if (i >= absent_from && i < absent_from + 40) {
        dance[i].presence &= ~(1u << arm);
        dance[i].R_PB[arm].setIdentity();
      } else if (i >= absent_from) {
        dance[i].R_PB[arm] = dance[i].R_PB[arm] * elsewhere;
      }
      predictor.observe(dance[i]);
      if (i == absent_from + 40) {
        EXPECT_LT(furthest_off(predictor, dance[i]), 0.02f) << absent_from;
      }
    }
  }
}

// A bone that stays where it seemed impossible is there, from the fifth frame on, and may come back
// from there at once.
TEST(LostLimbs, HoldsABoneNoLongerThanItTakesToBelieveIt) {
  const std::size_t leg = index_of(Bone::kLeftUpperLeg);
  auto dance = salsa(300);
  for (std::size_t i = 240; i < 250; ++i)
    dance[i].R_PB[leg] = dance[i].R_PB[leg] * exp_rotation(Eigen::Vector3f(0.0f, 3.0f, 0.5f));
  DancePredictor predictor(built_in_predict_model());
  for (std::size_t i = 0; i < 252; ++i) {
    predictor.observe(dance[i]);
    const float off = furthest_off(predictor, dance[i]);
    if (i >= 240 && i < 244) {
      EXPECT_GT(off, 2.0f) << i;
    } else {
      EXPECT_LT(off, 0.02f) << i;
    }
  }
  EXPECT_EQ(predictor.held_bones(), 4u);
}

// Dancers spin: what was predicted of them is judged by how far they really turned.
TEST(DancePredictor, FollowsWhoSpins) {
  auto dance = standing(900);
  for (std::size_t i = 0; i < dance.size(); ++i) {
    const float angle = 9.0f * static_cast<float>(i) / 60.0f;
    dance[i].R_PB[0] =
        Eigen::Quaternionf(Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitY())) * dance[i].R_PB[0];
  }
  DancePredictor predictor(built_in_predict_model());
  double off = 0.0;
  for (std::size_t i = 0; i + 24 < dance.size(); ++i) {
    predictor.observe(dance[i]);
    if (i < 600) continue;
    Pose shown;
    predictor.predict(dance[i].capture_time + Duration::ms(400), shown);
    off += static_cast<double>(shown.R_PB[0].angularDistance(dance[i + 24].R_PB[0])) / 276.0;
  }
  EXPECT_LT(off, 0.4) << "of 3.6 rad";
}

}  // namespace
}  // namespace dance

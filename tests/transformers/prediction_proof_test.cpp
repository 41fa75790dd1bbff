#include "transformers/predict/blend/prediction_proof.h"

#include <gtest/gtest.h>

#include <memory>

namespace dance {
namespace {

// A dancer who stands, and of whom it is predicted that each bone turns by `prediction`.
std::unique_ptr<MomentPredictions> predicting(float prediction) {
  auto predictions = std::make_unique<MomentPredictions>();
  for (BodyRow& row : predictions->common) row.v.fill(0.0f);
  for (BodyRow& row : predictions->personal) row.v.fill(0.0f);
  for (BodyRow& row : predictions->blended) row.v.fill(prediction);
  return predictions;
}

BodyRow all(float value) {
  BodyRow row;
  row.v.fill(value);
  return row;
}

TEST(PredictionProof, KnowsADancerByTheBonesThatAreSeen) {
  PredictionProof proof;
  auto predictions = predicting(0.0f);
  for (BodyRow& row : predictions->impersonal) row.v.fill(0.0f);
  // Half of the bones are seen, and the personal model is right about those.
  constexpr std::uint32_t kSeen = 0x555555u & kAllBones;
  BodyRow way = all(0.0f);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    for (std::size_t axis = 0; axis < 3 && (kSeen >> b & 1u); ++axis)
      predictions->personal[2](b, axis) = way(b, axis) = 0.2f;
  for (int i = 0; i < 10; ++i) proof.learn(2, *predictions, way);
  const float all_bones = proof.proved(2, kAllBones);
  EXPECT_GT(all_bones, 0.05f);
  EXPECT_LT(all_bones, 0.9f);
  EXPECT_NEAR(proof.proved(2, kSeen), std::min(1.0f, all_bones * 21.0f / 10.0f), 1e-5f);
  EXPECT_EQ(proof.proved(2, 0u), 0.0f);
}

}  // namespace
}  // namespace dance

#include "transformers/predict/guess_proof.h"

#include <gtest/gtest.h>

#include <memory>

namespace dance {
namespace {

// A dancer who stands, and of whom it is guessed that each bone turns by `guess`.
std::unique_ptr<MomentGuesses> guessing(float guess) {
  auto guesses = std::make_unique<MomentGuesses>();
  for (BodyRow& row : guesses->common) row.v.fill(0.0f);
  for (BodyRow& row : guesses->personal) row.v.fill(0.0f);
  for (BodyRow& row : guesses->blended) row.v.fill(guess);
  return guesses;
}

BodyRow all(float value) {
  BodyRow row;
  row.v.fill(value);
  return row;
}

TEST(GuessProof, KnowsADancerByTheBonesThatAreSeen) {
  GuessProof proof;
  auto guesses = guessing(0.0f);
  for (BodyRow& row : guesses->impersonal) row.v.fill(0.0f);
  // Half of the bones are seen, and the personal model is right about those.
  constexpr std::uint32_t kSeen = 0x555555u & kAllBones;
  BodyRow way = all(0.0f);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    for (std::size_t axis = 0; axis < 3 && (kSeen >> b & 1u); ++axis)
      guesses->personal[2](b, axis) = way(b, axis) = 0.2f;
  for (int i = 0; i < 10; ++i) proof.learn(2, *guesses, way);
  const float all_bones = proof.proved(2, kAllBones);
  EXPECT_GT(all_bones, 0.05f);
  EXPECT_LT(all_bones, 0.9f);
  EXPECT_NEAR(proof.proved(2, kSeen), std::min(1.0f, all_bones * 21.0f / 10.0f), 1e-5f);
  EXPECT_EQ(proof.proved(2, 0u), 0.0f);
}

}  // namespace
}  // namespace dance

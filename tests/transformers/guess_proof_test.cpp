#include "transformers/guess_proof.h"

#include <gtest/gtest.h>

#include <memory>

namespace dance {
namespace {

std::array<float, kRowGroups> levers() {
  std::array<float, kRowGroups> lever;
  lever.fill(0.5f);
  return lever;
}

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

TEST(GuessProof, GivesWayToStandingStillWhereThatWasBetter) {
  GuessProof proof(levers());
  const auto guesses = guessing(0.3f);
  BodyRow way;
  proof.finish(2, *guesses, way);
  EXPECT_EQ(way.v[0], 0.3f) << "nothing is known against it";
  for (int i = 0; i < 60; ++i) proof.learn(2, *guesses, all(0.0f));
  proof.finish(2, *guesses, way);
  EXPECT_LT(way.v[0], 0.01f);
  for (int i = 0; i < 150; ++i) proof.learn(2, *guesses, all(0.3f));
  proof.finish(2, *guesses, way);
  EXPECT_EQ(way.v[0], 0.3f) << "it is right again";
}

TEST(GuessProof, DoesNotWaitForASecondWhereTheNearerGuessesAreWrong) {
  GuessProof proof(levers());
  const auto guesses = guessing(0.3f);
  // Right at the longest horizon until now, but what is nearer went wrong since.
  for (int i = 0; i < 60; ++i) proof.learn(7, *guesses, all(0.3f));
  for (int i = 0; i < 60; ++i) proof.learn(5, *guesses, all(0.0f));
  BodyRow way;
  proof.finish(7, *guesses, way);
  EXPECT_GT(way.v[0], 0.01f);
  EXPECT_LT(way.v[0], 0.1f);
  proof.finish(3, *guesses, way);
  EXPECT_EQ(way.v[0], 0.3f) << "what is nearer than that is not concerned";
}

TEST(GuessProof, KnowsADancerByTheBonesThatAreSeen) {
  GuessProof proof(levers());
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

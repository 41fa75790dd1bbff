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

}  // namespace
}  // namespace dance

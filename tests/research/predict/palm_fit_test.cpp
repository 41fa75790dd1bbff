#include "research/predict/palm_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr std::size_t kFittedMoments = 3000;

PalmWeights some_weights(Random& random) {
  PalmWeights weights{};
  for (std::size_t g = 0; g < kPalmGuesses; ++g)
    for (std::size_t s = 0; s < kPalmSigns; ++s)
      if (is_palm_sign_weighed(static_cast<PalmGuess>(g), static_cast<PalmSign>(s)))
        weights[g][s] = 0.3f * static_cast<float>(random.normal());
  return weights;
}

// Guesses some centimetres away, by both of the partner's palms.
PalmGuesses some_guesses(Random& random) {
  PalmGuesses said;
  said.near = 1.0f;
  for (std::size_t k = 0; k < 2; ++k) {
    said.by[k].share = k == 0 ? 0.7f : 0.3f;
    for (Vector3f& guess : said.by[k].guesses_m)
      for (float& metres : guess) metres = 0.05f * static_cast<float>(random.normal());
    for (float& sign : said.by[k].signs) sign = static_cast<float>(random.normal());
    said.by[k].signs[static_cast<std::size_t>(PalmSign::kOne)] = 1.0f;
  }
  return said;
}

Vector3f told_by(const PalmGuesses& said, const PalmWeights& weights) {
  const PalmGuesses::Sum sum = said.weighed(weights);
  return sum.by_partner + sum.by_misses;
}

float furthest(const PalmWeights& a, const PalmWeights& b) {
  float most = 0.0f;
  for (std::size_t g = 0; g < kPalmGuesses; ++g)
    for (std::size_t s = 0; s < kPalmSigns; ++s) most = std::max(most, std::abs(a[g][s] - b[g][s]));
  return most;
}

// Every so-many-th palm went where other weights would have told it, and is held or not.
std::vector<PalmMoment> moments_of(const PalmWeights& weights, const PalmWeights& others,
                                   std::size_t others_of_ten, bool others_held, Random& random) {
  std::vector<PalmMoment> moments;
  for (std::size_t i = 0; i < kFittedMoments; ++i) {
    const bool is_other = i % 10 < others_of_ten;
    const PalmGuesses said = some_guesses(random);
    moments.push_back({said, told_by(said, is_other ? others : weights), i / 10 % 2,
                       is_other ? others_held : i % 10 == 9});
  }
  return moments;
}

TEST(PalmFit, GivesBackTheWeightsThatMadeTheMoments) {
  Random random(1);
  const PalmWeights weights = some_weights(random);
  const auto fitted = fit_palms(moments_of(weights, weights, 0, false, random));
  ASSERT_TRUE(fitted.has_value()) << fitted.error().what;
  EXPECT_LT(furthest(*fitted, weights), 0.01f);
}

TEST(PalmFit, PalmsThatGoElsewhereNowAndThenPullLittle) {
  Random random(2);
  const PalmWeights weights = some_weights(random);
  PalmWeights against = weights;
  for (auto& signs : against)
    for (float& weight : signs) weight = -weight;
  const auto fitted = fit_palms(moments_of(weights, against, 2, false, random));
  ASSERT_TRUE(fitted.has_value()) << fitted.error().what;
  // Least squares would take two fifths off each of them.
  EXPECT_LT(furthest(*fitted, weights), 0.06f);
}

TEST(PalmFit, PalmsInAHoldCountMore) {
  Random random(3);
  const PalmWeights weights = some_weights(random), in_a_hold = some_weights(random);
  const auto fitted = fit_palms(moments_of(weights, in_a_hold, 4, true, random));
  ASSERT_TRUE(fitted.has_value()) << fitted.error().what;
  EXPECT_LT(furthest(*fitted, in_a_hold), 0.5f * furthest(*fitted, weights));
}

TEST(PalmFit, SaysThatMomentsAreTooFew) {
  Random random(4);
  const PalmWeights weights = some_weights(random);
  auto moments = moments_of(weights, weights, 0, false, random);
  // Out of reach they do not count.
  for (std::size_t i = 100; i < moments.size(); ++i) moments[i].said.near = 0.0f;
  const auto fitted = fit_palms(moments);
  ASSERT_FALSE(fitted.has_value());
  EXPECT_NE(fitted.error().what.find("at 100 moments"), std::string::npos) << fitted.error().what;
}

TEST(PalmFit, PrintsTheTableAsItIsBuiltIn) {
  PalmWeights weights{};
  weights[0][0] = 0.25f;
  weights[1][2] = -0.0001f;
  const std::string text = palm_weights_text(weights);
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "    {{0.250f, 0.000f, 0.000f, 0.000f, 0.000f, 0.000f, 0.000f}},");
  EXPECT_EQ(text.find('-'), std::string::npos);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), static_cast<std::ptrdiff_t>(kPalmGuesses));
}

}  // namespace
}  // namespace dance

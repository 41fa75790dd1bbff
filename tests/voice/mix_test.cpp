#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/voice/voices.h"
#include "voice/mix/limiter.h"
#include "voice/mix/spatial_voice.h"
#include "voice/room/stage_places.h"

namespace dance {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

struct Ears {
  double left = 0.0, right = 0.0;
  std::vector<float> stereo;
};

// After it has settled.
Ears ears_at(float azimuth_rad, float distance_m) {
  SpatialVoice voice;
  voice.set_place(azimuth_rad, distance_m);
  const auto mono = hummed(1.0, false);
  Ears ears;
  ears.stereo.assign(2 * mono.size(), 0.0f);
  voice.mix(mono, ears.stereo);
  for (std::size_t i = mono.size() / 2; i < mono.size(); ++i) {
    ears.left += std::pow(static_cast<double>(ears.stereo[2 * i]), 2);
    ears.right += std::pow(static_cast<double>(ears.stereo[2 * i + 1]), 2);
  }
  return ears;
}

TEST(SpatialVoice, IsLouderAtTheNearerEarAndAsLoudInAll) {
  const Ears ahead = ears_at(0.0f, 1.0f);
  EXPECT_NEAR(ahead.left / ahead.right, 1.0, 0.01);
  for (const float azimuth : {0.3f, 1.0f, kPi / 2.0f, 2.5f}) {
    const Ears at_left = ears_at(azimuth, 1.0f), at_right = ears_at(-azimuth, 1.0f);
    EXPECT_GT(at_left.left, 1.2 * at_left.right) << azimuth;
    EXPECT_NEAR(at_left.left / at_right.right, 1.0, 0.02) << azimuth;
    EXPECT_NEAR((at_left.left + at_left.right) / (ahead.left + ahead.right), 1.0, 0.02) << azimuth;
  }
}

TEST(SpatialVoice, ComesToTheFurtherEarLater) {
  const Ears ears = ears_at(kPi / 2.0f, 1.0f);
  const std::size_t half = ears.stereo.size() / 4;
  int best = -1;
  double most = 0.0;
  for (int late = 0; late < 60; ++late) {
    double sum = 0.0;
    for (std::size_t i = half; i + 60 < 2 * half; ++i)
      sum += static_cast<double>(ears.stereo[2 * i]) *
             static_cast<double>(ears.stereo[2 * (i + static_cast<std::size_t>(late)) + 1]);
    if (sum > most) {
      most = sum;
      best = late;
    }
  }
  EXPECT_NEAR(best / 48.0, 0.656, 0.05) << "milliseconds, for a head of 17.5 cm";
}

TEST(SpatialVoice, IsQuieterFromFarButNeverLost) {
  EXPECT_GT(ears_at(0.0f, 1.0f).left, 3.0 * ears_at(0.0f, 2.0f).left);
  EXPECT_NEAR(ears_at(0.0f, 0.1f).left / ears_at(0.0f, 1.0f).left, 1.0, 0.01);
  EXPECT_GT(ears_at(0.0f, 500.0f).left, 0.05 * ears_at(0.0f, 1.0f).left);
}

TEST(SpatialVoice, MovesWithoutAClick) {
  SpatialVoice voice;
  std::vector<float> mono(48'000, 0.5f), stereo(96'000, 0.0f);
  voice.mix(std::span(mono).first(24'000), std::span(stereo).first(48'000));
  voice.set_place(-kPi / 2.0f, 3.0f);
  voice.set_volume(0.0f);
  voice.mix(std::span(mono).subspan(24'000), std::span(stereo).subspan(48'000));
  for (std::size_t i = 2'000; i + 2 < stereo.size(); ++i)
    ASSERT_LT(std::abs(stereo[i + 2] - stereo[i]), 0.002f) << i;
}

TEST(SpatialVoice, APlaceThatIsNoneIsIgnored) {
  SpatialVoice voice;
  voice.set_place(std::nanf(""), 1.0f);
  voice.set_place(0.0f, INFINITY);
  std::vector<float> mono(100, 0.5f), stereo(200, 0.0f);
  voice.mix(mono, stereo);
  for (const float sample : stereo) ASSERT_TRUE(std::isfinite(sample));
}

TEST(Limiter, KeepsBelowFullScaleAndLeavesQuietSoundAlone) {
  Limiter limiter;
  std::vector<float> quiet(960, 0.3f);
  limiter.limit(quiet);
  for (const float sample : quiet) ASSERT_EQ(sample, 0.3f);
  std::vector<float> loud(9600);
  for (std::size_t i = 0; i < loud.size(); ++i) loud[i] = i % 4 < 2 ? 3.0f : -3.0f;
  limiter.limit(loud);
  for (const float sample : loud) ASSERT_LE(std::abs(sample), Limiter::kLoudest + 1e-5f);
  std::vector<float> after(2 * 96'000, 0.3f);
  limiter.limit(after);
  EXPECT_NEAR(after.back(), 0.3f, 0.01f) << "and turns up again";
}

TEST(StagePlaces, SaysWhereAnothersDancerStandsForMine) {
  StagePlaces places;
  const auto alice = *GuestId::parse("alice"), bob = *GuestId::parse("bob");
  Pose pose;
  pose.p_WH_m = {0.0f, 1.0f, 0.0f};
  places.see(alice, pose);
  EXPECT_FALSE(places.place_of(bob, alice));
  pose.p_WH_m = {2.0f, 0.9f, 0.0f};  // +X is at the left of one who faces +Z
  places.see(bob, pose);
  ASSERT_TRUE(places.place_of(bob, alice));
  EXPECT_NEAR(places.place_of(bob, alice)->azimuth_rad, kPi / 2.0f, 1e-4f);
  EXPECT_NEAR(places.place_of(bob, alice)->distance_m, 2.0f, 1e-4f);
  // Turned to the left, alice has bob before her.
  pose.p_WH_m = {0.0f, 1.0f, 0.0f};
  pose.R_PB[0] = about_up(kPi / 2.0f);
  places.see(alice, pose);
  EXPECT_NEAR(places.place_of(bob, alice)->azimuth_rad, 0.0f, 1e-4f);
  EXPECT_FALSE(places.place_of(alice, alice));
}

TEST(StagePlaces, HasABound) {
  StagePlaces places;
  const auto listener = *GuestId::parse("me");
  for (int i = 0; i < 200; ++i) places.see(*GuestId::parse("g" + std::to_string(i)), Pose());
  places.see(listener, Pose());
  EXPECT_TRUE(places.place_of(*GuestId::parse("g199"), listener));
  EXPECT_FALSE(places.place_of(*GuestId::parse("g0"), listener));
}

}  // namespace
}  // namespace dance

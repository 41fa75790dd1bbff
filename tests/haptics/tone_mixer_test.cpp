#include "haptics/sound/tone_mixer.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/haptics/haptic_notes.h"

namespace dance {
namespace {

constexpr double kRate_hz = 48000.0;

std::vector<float> mixed(ToneMixer& mixer, std::size_t frames) {
  std::vector<float> samples(frames);
  mixer.mix(samples);
  return samples;
}

TEST(ToneMixer, AToneHasItsLengthItsPitchAndItsEnvelope) {
  ToneMixer mixer(kRate_hz);
  Haptic haptic = some_haptic(MonoTime());
  haptic.duration = Duration::ms(100);
  haptic.attack = Duration::ms(50);
  haptic.frequency_hz = 100.0f;
  mixer.add(haptic);
  const auto samples = mixed(mixer, 9600);
  float first = 0.0f, later = 0.0f, after = 0.0f;
  int crossings = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    float& most = i < 480 ? first : i < 4800 ? later : after;
    most = std::max(most, std::abs(samples[i]));
    if (i > 0 && i < 4800) crossings += (samples[i] > 0.0f) != (samples[i - 1] > 0.0f);
  }
  EXPECT_LT(first, 0.12f);
  EXPECT_NEAR(later, 0.5f, 0.05f);
  EXPECT_EQ(after, 0.0f);
  EXPECT_NEAR(crossings, 20, 2);
  EXPECT_TRUE(mixer.is_silent());
}

TEST(ToneMixer, DoesNotClick) {
  ToneMixer mixer(kRate_hz);
  for (int i = 0; i < 3; ++i) mixer.add(some_haptic(MonoTime()));
  float before = 0.0f, most = 0.0f;
  for (const float sample : mixed(mixer, 9600)) {
    most = std::max(most, std::abs(sample - before));
    before = sample;
  }
  EXPECT_LT(most, 0.05f);
}

TEST(ToneMixer, ManyTonesAreBoundedAndNeverTooLoud) {
  ToneMixer mixer(kRate_hz);
  Haptic haptic = some_haptic(MonoTime());
  haptic.amplitude = 1.0f;
  for (int i = 0; i < 100; ++i) mixer.add(haptic);
  for (const float sample : mixed(mixer, 4800)) EXPECT_LE(std::abs(sample), 1.0f);
  // In sum, too, nothing is above the limit.
  mixer.set_limit(0.6f);
  for (int i = 0; i < 100; ++i) mixer.add(haptic);
  for (const float sample : mixed(mixer, 4800)) EXPECT_LE(std::abs(sample), 0.6f);
  for (int i = 0; i < 100; ++i) mixer.add(haptic);
  mixer.clear();
  for (const float sample : mixed(mixer, 480)) EXPECT_EQ(sample, 0.0f);
}

}  // namespace
}  // namespace dance

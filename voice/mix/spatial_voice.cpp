#include "voice/mix/spatial_voice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dance {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kHeadRadius_samples = 0.0875f / 343.0f * 48'000.0f;
// At the far ear of a voice at the side the head takes away about ten decibels, not all of it.
constexpr float kWidth = 0.72f;
// Nearer is not louder; and across a large stage a voice is still understood.
constexpr float kNear_m = 1.0f;
constexpr float kQuietest = 0.25f;

}  // namespace

void SpatialVoice::set_place(float azimuth_rad, float distance_m) {
  if (!std::isfinite(azimuth_rad) || !std::isfinite(distance_m)) return;
  const float left = std::sin(azimuth_rad);  // 1 at the left ear
  const float lateral = std::asin(std::clamp(left, -1.0f, 1.0f));
  // Equal power: squares of the two gains add up to the same wherever the voice is.
  const float pan = 0.25f * kPi * (1.0f + kWidth * left);
  const float distance = std::clamp(kNear_m / std::max(distance_m, kNear_m), kQuietest, 1.0f);
  const float between = kHeadRadius_samples * (std::abs(lateral) + std::abs(left));
  wanted_[0] = {std::sin(pan) * distance, left < 0.0f ? between : 0.0f};
  wanted_[1] = {std::cos(pan) * distance, left > 0.0f ? between : 0.0f};
}

float SpatialVoice::late(float delay) const {
  const auto whole = static_cast<std::size_t>(delay);
  const float part = delay - static_cast<float>(whole);
  const float a = history_[(newest_ + kHistory - whole) % kHistory];
  const float b = history_[(newest_ + kHistory - whole - 1) % kHistory];
  return a + part * (b - a);
}

void SpatialVoice::mix(std::span<const float> mono, std::span<float> stereo) {
  for (std::size_t i = 0; i < mono.size(); ++i) {
    newest_ = (newest_ + 1) % kHistory;
    history_[newest_] = mono[i];
    volume_now_ += kSmoothing * (volume_ - volume_now_);
    for (std::size_t e = 0; e < 2; ++e) {
      Ear& ear = ears_[e];
      ear.gain += kSmoothing * (wanted_[e].gain - ear.gain);
      ear.delay += kSmoothing * (wanted_[e].delay - ear.delay);
      stereo[2 * i + e] += volume_now_ * ear.gain * late(ear.delay);
    }
  }
}

}  // namespace dance

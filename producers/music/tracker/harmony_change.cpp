#include "producers/music/tracker/harmony_change.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr double kThinnedRate_hz = 5512.5;
constexpr double kHarmonyWindow_s = 0.186;  // separates semitones from 120 Hz on
constexpr double kLowest_hz = 60.0;
constexpr double kHighest_hz = 2000.0;
constexpr std::size_t kNeighbours = 7;  // a tone stands out of so many bins on either side
constexpr double kMeanTime_hops = 600.0;
constexpr double kFaintestTone = 3e-6;
constexpr float kToneContrast = 2.0f;

}  // namespace

HarmonyChange::HarmonyChange(double sample_rate_hz) {
  DANCE_ASSERT(sample_rate_hz >= 4000.0);
  thinning_ = static_cast<std::size_t>(std::max(1L, std::lround(sample_rate_hz / kThinnedRate_hz)));
  const double rate_hz = sample_rate_hz / static_cast<double>(thinning_);
  const std::size_t n = std::size_t{1} << std::lround(std::log2(rate_hz * kHarmonyWindow_s));
  recent_.assign(n, 0.0f);
  weighted_.assign(n, 0.0f);
  window_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    window_[i] =
        static_cast<float>((1.0 - std::cos(2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) /
                                           static_cast<double>(n))) /
                           static_cast<double>(n));
  spectrum_.resize(n / 2 + 1);
  fft_.SetFlag(Eigen::FFT<float>::HalfSpectrum);
  fft_.fwd(spectrum_.data(), weighted_.data(), static_cast<int>(n));  // makes its tables here
  bin_hz_ = rate_hz / static_cast<double>(n);
  first_bin_ = static_cast<std::size_t>(std::ceil(kLowest_hz / bin_hz_));
  bins_ = static_cast<std::size_t>(std::min(kHighest_hz, 0.45 * rate_hz) / bin_hz_) - first_bin_;
  loudness_.assign(bins_, 0.0f);
  tones_.assign(bins_, 0.0f);
  history_.assign(kLag * bins_, 0.0f);
}

// What stands out of its neighbourhood: drums raise a whole neighbourhood and show little.
void HarmonyChange::find_tones(std::span<float> tones) {
  double sum = 0.0;
  for (std::size_t i = 0; i < bins_; ++i) {
    loudness_[i] = std::abs(spectrum_[first_bin_ + i]);
    sum += loudness_[i];
  }
  const double weight = 1.0 / std::min(static_cast<double>(hops_ + 1), kMeanTime_hops);
  mean_ += weight * (sum / static_cast<double>(bins_) - mean_);
  const auto scale = kToneContrast / static_cast<float>(std::max(mean_, kFaintestTone));
  for (float& l : loudness_) l = std::log1p(scale * l);
  float near = 0.0f;
  for (std::size_t i = 0; i < kNeighbours; ++i) near += loudness_[i];
  for (std::size_t i = 0; i < bins_; ++i) {
    if (i + kNeighbours < bins_) near += loudness_[i + kNeighbours];
    if (i > kNeighbours) near -= loudness_[i - kNeighbours - 1];
    tones[i] = std::max(0.0f, loudness_[i] - near / static_cast<float>(2 * kNeighbours + 1));
  }
}

float HarmonyChange::push(std::span<const float> hop) {
  for (const float x : hop) {
    gathered_ += x;
    if (++gathered_count_ < thinning_) continue;
    recent_[newest_] = gathered_ / static_cast<float>(thinning_);
    newest_ = (newest_ + 1) % recent_.size();
    gathered_ = 0.0f;
    gathered_count_ = 0;
  }
  const std::size_t older = recent_.size() - newest_;
  for (std::size_t i = 0; i < older; ++i) weighted_[i] = recent_[newest_ + i] * window_[i];
  for (std::size_t i = 0; i < newest_; ++i) weighted_[older + i] = recent_[i] * window_[older + i];
  fft_.fwd(spectrum_.data(), weighted_.data(), static_cast<int>(recent_.size()));
  find_tones(tones_);

  float change = 0.0f;
  float* past = history_.data() + row_ * bins_;
  for (std::size_t i = 0; i < bins_; ++i) {
    const float highest =
        std::max({past[i], i > 0 ? past[i - 1] : 0.0f, i + 1 < bins_ ? past[i + 1] : 0.0f});
    change += std::max(0.0f, tones_[i] - highest);
  }
  std::copy(tones_.begin(), tones_.end(), past);
  row_ = (row_ + 1) % kLag;
  ++hops_;
  return change;
}

}  // namespace dance

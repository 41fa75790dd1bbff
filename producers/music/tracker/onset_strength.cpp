#include "producers/music/tracker/onset_strength.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr double kWindow_s = 0.046;
constexpr double kLowestBand_hz = 30.0;
constexpr double kHighestBand_hz = 11000.0;
constexpr double kBandsAnOctave = 5.0;
// Where the groups meet: bass and kick, drums' bodies and chords, voices and melody, cymbals and
// shakers.
constexpr std::array<double, 3> kGroupEnds_hz{160.0, 800.0, 4000.0};
constexpr std::size_t kHarmony = kGroupEnds_hz.size() + 1;
static_assert(kHarmony + 1 == kOnsetGroups);
constexpr double kLevelTime_s = 6.0;
constexpr double kMeanTime_s = 8.0;
// Full scale is 1: noise of 16 bits lies below this and stays silence.
constexpr float kFaintest = 3e-5f;
// Loudness is log(1 + kContrast * magnitude / its mean).
constexpr float kContrast = 4.0f;

// A mean over `time_s`, and over what there was so far before that.
double follow_weight(std::size_t hops, double time_s) {
  const double so_far_s = static_cast<double>(hops + 1) / OnsetStrength::kHops_hz;
  return 1.0 / (std::min(so_far_s, time_s) * OnsetStrength::kHops_hz);
}

}  // namespace

OnsetStrength::OnsetStrength(double sample_rate_hz)
    : sample_rate_hz_(sample_rate_hz), harmony_(sample_rate_hz) {
  DANCE_ASSERT(sample_rate_hz >= kLeastRate_hz && sample_rate_hz <= kMostRate_hz);
  hop_ = static_cast<std::size_t>(std::lround(sample_rate_hz / kHops_hz));
  window_samples_ = 1 << std::lround(std::log2(sample_rate_hz * kWindow_s));
  const auto n = static_cast<std::size_t>(window_samples_);
  window_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    window_[i] =
        static_cast<float>((1.0 - std::cos(2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) /
                                           static_cast<double>(n))) /
                           static_cast<double>(n));
  recent_.assign(n, 0.0f);
  weighted_.assign(n, 0.0f);
  spectrum_.resize(n / 2 + 1);
  fft_.SetFlag(Eigen::FFT<float>::HalfSpectrum);
  fft_.fwd(spectrum_.data(), weighted_.data(), window_samples_);  // makes its tables here
  make_bands();
}

void OnsetStrength::make_bands() {
  const double bin_hz = sample_rate_hz_ / window_samples_;
  const double highest_hz = std::min(kHighestBand_hz, 0.45 * sample_rate_hz_);
  const double ratio = std::exp2(1.0 / kBandsAnOctave);
  int first = std::max(1, static_cast<int>(std::ceil(kLowestBand_hz / bin_hz)));
  for (double end_hz = kLowestBand_hz * ratio; bands_.size() < kMostBands; end_hz *= ratio) {
    const int end = static_cast<int>(std::ceil(std::min(end_hz, highest_hz) / bin_hz));
    if (end > first) {
      const double centre_hz = 0.5 * (first + end - 1) * bin_hz;
      std::size_t group = 0;
      while (group < kGroupEnds_hz.size() && centre_hz > kGroupEnds_hz[group]) ++group;
      bands_.push_back({first, end, group});
      first = end;
    }
    if (end_hz >= highest_hz) break;
  }
}

void OnsetStrength::compress(std::span<float> loudness) {
  const auto weight = static_cast<float>(follow_weight(hops_, kLevelTime_s));
  for (std::size_t b = 0; b < bands_.size(); ++b) {
    float power = 0.0f;
    for (int i = bands_[b].first_bin; i < bands_[b].end_bin; ++i)
      power += std::norm(spectrum_[static_cast<std::size_t>(i)]);
    const float magnitude = std::sqrt(power);
    level_[b] += weight * (magnitude - level_[b]);
    loudness[b] = std::log1p(kContrast * magnitude / std::max(level_[b], kFaintest));
  }
}

OnsetStrength::Strengths OnsetStrength::push(std::span<const float> hop) {
  DANCE_ASSERT(hop.size() == hop_);
  std::move(recent_.begin() + static_cast<std::ptrdiff_t>(hop_), recent_.end(), recent_.begin());
  std::transform(hop.begin(), hop.end(), recent_.end() - static_cast<std::ptrdiff_t>(hop_),
                 [](float x) { return std::isfinite(x) ? std::clamp(x, -1e3f, 1e3f) : 0.0f; });
  for (std::size_t i = 0; i < recent_.size(); ++i) weighted_[i] = recent_[i] * window_[i];
  fft_.fwd(spectrum_.data(), weighted_.data(), window_samples_);

  std::array<float, kMostBands> loudness{};
  compress(loudness);
  const std::array<float, kMostBands>& past = before_[kLag - 1];
  std::array<double, kOnsetGroups> rise{};
  for (std::size_t b = 0; b < bands_.size(); ++b) {
    float highest = past[b];
    if (b > 0) highest = std::max(highest, past[b - 1]);
    if (b + 1 < bands_.size()) highest = std::max(highest, past[b + 1]);
    rise[bands_[b].group] += std::max(0.0f, loudness[b] - highest);
  }
  rise[kHarmony] = harmony_.push(std::span(recent_).last(hop_));
  std::move_backward(before_.begin(), before_.end() - 1, before_.end());
  before_[0] = loudness;

  const double weight = follow_weight(hops_, kMeanTime_s);
  Strengths strengths{};
  for (std::size_t g = 0; g < kOnsetGroups; ++g) {
    mean_[g] += weight * (rise[g] - mean_[g]);
    strengths[g] = mean_[g] > 1e-4 ? static_cast<float>(rise[g] / mean_[g]) : 0.0f;
  }
  ++hops_;
  return strengths;
}

}  // namespace dance

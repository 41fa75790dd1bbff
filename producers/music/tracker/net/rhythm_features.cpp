#include "producers/music/tracker/net/rhythm_features.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"

namespace dance {
namespace {

// Wide enough below to hold a bin at any sample rate, half an octave above.
constexpr std::array<double, RhythmFeatures::kBands + 1> kBandEnds_hz{
    35.0,  75.0,   120.0,  170.0,  240.0,  340.0,  480.0,  680.0,
    960.0, 1360.0, 1920.0, 2720.0, 3840.0, 5440.0, 7680.0, 11000.0};
constexpr double kLowestTone_hz = 62.0;
constexpr double kTonesAnOctave = 6.0;
constexpr double kBandLevelTime_hops = 600.0;
constexpr float kFaintestBand = 3e-5f;
constexpr float kBandContrast = 4.0f;
// A rise is one over so many hops; a tone is new when it did not sound so long ago.
constexpr std::size_t kRiseLag_hops = 2;
constexpr std::size_t kToneLag_hops = 16;
constexpr float kMostStrength = 15.0f;

template <std::size_t N>
float rise_of(const std::array<float, N>& now, const std::array<float, N>& past, std::size_t i) {
  float highest = past[i];
  if (i > 0) highest = std::max(highest, past[i - 1]);
  if (i + 1 < N) highest = std::max(highest, past[i + 1]);
  return std::max(0.0f, now[i] - highest);
}

}  // namespace

RhythmFeatures::RhythmFeatures(const OnsetStrength& onsets) {
  for (std::size_t i = 0; i < onsets.spectrum().size(); ++i) {
    const double hz = static_cast<double>(i) * onsets.bin_hz();
    const auto end = std::upper_bound(kBandEnds_hz.begin(), kBandEnds_hz.end(), hz);
    const bool is_in = end != kBandEnds_hz.begin() && end != kBandEnds_hz.end();
    band_of_bin_.push_back(is_in ? static_cast<std::size_t>(end - kBandEnds_hz.begin()) - 1
                                 : kBands);
  }
  for (std::size_t i = 0; i < onsets.harmony().tones().size(); ++i) {
    const double row =
        std::floor(kTonesAnOctave * std::log2(onsets.harmony().tone_hz(i) / kLowestTone_hz));
    const bool is_in = row >= 0.0 && row < static_cast<double>(kTones);
    row_of_tone_.push_back(is_in ? static_cast<std::size_t>(row) : kTones);
  }
}

bool RhythmFeatures::push(const OnsetStrength& onsets, const OnsetStrength::Strengths& strengths) {
  newest_ = (newest_ + 1) % ring_.size();
  Hop& hop = ring_[newest_];
  std::array<float, kBands + 1> power{};
  for (std::size_t i = 0; i < band_of_bin_.size(); ++i)
    power[band_of_bin_[i]] += std::norm(onsets.spectrum()[i]);
  const auto weight =
      static_cast<float>(1.0 / std::min(static_cast<double>(hops_ + 1), kBandLevelTime_hops));
  for (std::size_t b = 0; b < kBands; ++b) {
    const float magnitude = std::sqrt(power[b]);
    level_[b] += weight * (magnitude - level_[b]);
    hop.loudness[b] = std::log1p(kBandContrast * magnitude / std::max(level_[b], kFaintestBand));
  }
  std::array<float, kTones + 1> rows{};
  for (std::size_t i = 0; i < row_of_tone_.size(); ++i)
    rows[row_of_tone_[i]] += onsets.harmony().tones()[i];
  std::copy_n(rows.begin(), kTones, hop.tones.begin());
  for (std::size_t g = 0; g < kOnsetGroups; ++g)
    hop.strengths[g] = std::min(strengths[g], kMostStrength);
  ++hops_;
  if (hops_ % kStep_hops != 0) return false;
  read();
  return true;
}

const RhythmFeatures::Hop& RhythmFeatures::before(std::size_t hops) const {
  static_assert(kToneLag_hops < kMemory && kStep_hops + kRiseLag_hops < kMemory);
  return ring_[(newest_ + kMemory - hops) % kMemory];
}

void RhythmFeatures::read() {
  auto out = values_.begin();
  for (std::size_t b = 0; b < kBands; ++b)
    *out++ = 0.5f * (before(0).loudness[b] + before(1).loudness[b]);
  for (std::size_t t = 0; t < kTones; ++t)
    *out++ = rise_of(before(0).tones, before(kToneLag_hops).tones, t);
  for (std::size_t k = 0; k < kStep_hops; ++k) {
    for (std::size_t b = 0; b < kBands; ++b)
      *out++ = rise_of(before(k).loudness, before(k + kRiseLag_hops).loudness, b);
    for (const float strength : before(k).strengths) *out++ = std::log1p(strength);
  }
  // How long there has been music: means are not settled at first.
  *out++ = static_cast<float>(std::exp(-static_cast<double>(hops_) / kBandLevelTime_hops));
  DANCE_ASSERT(out == values_.end());
}

}  // namespace dance

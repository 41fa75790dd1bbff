#include "producers/music/tracker/stroke_features.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"

namespace dance {
namespace {

// Wide enough below to hold a bin at any sample rate, half an octave above.
constexpr std::array<double, StrokeFeatures::kBands + 1> kBandEnds_hz{
    35.0,  75.0,   120.0,  170.0,  240.0,  340.0,  480.0,  680.0,
    960.0, 1360.0, 1920.0, 2720.0, 3840.0, 5440.0, 7680.0, 11000.0};
constexpr double kLowestTone_hz = 62.0;
constexpr double kTonesAnOctave = 6.0;
constexpr double kBandLevelTime_hops = 600.0;
constexpr float kFaintestBand = 3e-5f;
constexpr float kBandContrast = 4.0f;
// A rise is one over so many hops; a tone is new when it did not sound so long ago.
constexpr int kRiseLag = 2;
constexpr int kToneLag = 16;
constexpr std::array kRiseAt_hops{1, 3, 5};
static_assert(kRiseAt_hops.size() == StrokeFeatures::kRises);
constexpr float kMostStrength = 15.0f;  // of a strength

template <std::size_t N>
float rise_of(const std::array<float, N>& now, const std::array<float, N>& past, std::size_t i) {
  float highest = past[i];
  if (i > 0) highest = std::max(highest, past[i - 1]);
  if (i + 1 < N) highest = std::max(highest, past[i + 1]);
  return std::max(0.0f, now[i] - highest);
}

}  // namespace

StrokeFeatures::StrokeFeatures(const OnsetStrength& onsets) : ring_(kMemory) {
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

void StrokeFeatures::push(const OnsetStrength& onsets, const OnsetStrength::Strengths& strengths) {
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
}

const StrokeFeatures::Hop& StrokeFeatures::at(int hops) const {
  const int back = static_cast<int>(kAhead_hops) - hops;
  DANCE_ASSERT(back >= 0 && back < kMemory);
  return ring_[(newest_ + ring_.size() - static_cast<std::size_t>(back)) % ring_.size()];
}

template <std::size_t N>
std::array<float, N> StrokeFeatures::mean(std::array<float, N> Hop::*row, int first,
                                          int last) const {
  std::array<float, N> sum{};
  for (int k = first; k <= last; ++k) {
    const std::array<float, N>& values = at(k).*row;
    for (std::size_t i = 0; i < N; ++i) sum[i] += values[i];
  }
  for (float& x : sum) x /= static_cast<float>(last - first + 1);
  return sum;
}

void StrokeFeatures::read(std::span<float, kCount> features) const {
  auto out = features.begin();
  const auto put_difference = [&](const auto& a, const auto& b) {
    out = std::transform(a.begin(), a.end(), b.begin(), out, std::minus<>{});
  };
  for (const int k : kRiseAt_hops)
    for (std::size_t b = 0; b < kBands; ++b)
      *out++ = rise_of(at(k).loudness, at(k - kRiseLag).loudness, b);
  put_difference(mean(&Hop::loudness, 4, 12), mean(&Hop::loudness, -40, -3));
  put_difference(mean(&Hop::loudness, 1, 4), mean(&Hop::loudness, -10, -2));
  for (std::size_t t = 0; t < kTones; ++t) *out++ = rise_of(at(kToneLag).tones, at(0).tones, t);
  put_difference(mean(&Hop::tones, 6, 17), mean(&Hop::tones, -30, 0));
  constexpr int kSpan_hops = 4;
  constexpr auto kLatest = static_cast<int>(kAhead_hops) / kSpan_hops - 1;
  for (int s = kLatest - static_cast<int>(kRhythm) + 1; s <= kLatest; ++s) {
    const auto strokes = mean(&Hop::strengths, kSpan_hops * s - 1, kSpan_hops * s + 2);
    for (std::size_t g = 0; g + 1 < kOnsetGroups; ++g) *out++ = std::log1p(strokes[g]);
  }
  constexpr std::size_t kNewTones = kOnsetGroups - 1;
  *out++ = std::log1p(at(kToneLag).strengths[kNewTones]);
  *out++ = std::log1p(at(kToneLag + 2).strengths[kNewTones]);
  *out++ = std::log1p(mean(&Hop::strengths, -30, 0)[kNewTones]);
  DANCE_ASSERT(out == features.end());
}

}  // namespace dance

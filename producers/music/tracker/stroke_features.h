// StrokeFeatures: what sounds around one moment, as numbers a network can judge it by: which bands
// rose and which tones are new, how loud each band is against before, and the strokes of the half
// second that led there. They
// describe the moment kAhead_hops ago, since a stroke can be classified only after it.
//
// Units/frames: one call a hop of onset strengths. Features are relative loudness in no unit; where
//               a band lies above what the sample rate can hold it is silent.
// Ownership:    keeps the last 0.8 s; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      none; before anything was heard all is silence.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "producers/music/tracker/onset_strength.h"

namespace dance {

class StrokeFeatures {
 public:
  static constexpr std::size_t kAhead_hops = 18;
  static constexpr std::size_t kBands = 15;
  static constexpr std::size_t kTones = 30;
  static constexpr std::size_t kRises = 3;    // moments at which bands may have risen
  static constexpr std::size_t kRhythm = 19;  // spans of 40 ms, the last of them after the moment
  static constexpr std::size_t kCount =
      (kRises + 2) * kBands + 2 * kTones + kRhythm * (kOnsetGroups - 1) + 3;
  // The moment whose features are read is this much before the end of the newest hop.
  static constexpr double kDelay_s =
      static_cast<double>(kAhead_hops) / OnsetStrength::kHops_hz + 0.010;

  explicit StrokeFeatures(const OnsetStrength& onsets);

  void push(const OnsetStrength& onsets, const OnsetStrength::Strengths& strengths);
  void read(std::span<float, kCount> features) const;

 private:
  static constexpr int kMemory = 84;
  struct Hop {
    std::array<float, kBands> loudness{};
    std::array<float, kTones> tones{};
    std::array<float, kOnsetGroups> strengths{};
  };

  // Hops after the moment that is judged; negative before it.
  const Hop& at(int hops) const;
  // Sums over hops from `first` to `last`, in the mean.
  template <std::size_t N>
  std::array<float, N> mean(std::array<float, N> Hop::*row, int first, int last) const;

  std::vector<std::size_t> band_of_bin_;  // kBands: none
  std::vector<std::size_t> row_of_tone_;  // kTones: none
  std::array<float, kBands> level_{};
  std::vector<Hop> ring_;
  std::size_t newest_ = 0;
  std::size_t hops_ = 0;
};

}  // namespace dance

// RhythmFeatures: what a network hears of music, fifty times a second: how loud each band of pitch
// is against before, which bands have just risen, which tones are new, and the onset strengths.
//
// Units/frames: one call a hop of onset strengths; a step is kStep_hops of them. Features are
//               relative loudness in no unit; where a band lies above what the sample rate can hold
//               it is silent.
// Ownership:    keeps the last 0.2 s; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      none; before anything was heard all is silence.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "producers/music/tracker/onset_strength.h"

namespace dance {

class RhythmFeatures {
 public:
  static constexpr std::size_t kBands = 15;
  static constexpr std::size_t kTones = 30;
  static constexpr std::size_t kStep_hops = 2;
  static constexpr std::size_t kCount = kBands + kTones + kStep_hops * (kBands + kOnsetGroups) + 1;

  explicit RhythmFeatures(const OnsetStrength& onsets);

  // Whether a step has ended with this hop, whose features are values() then.
  bool push(const OnsetStrength& onsets, const OnsetStrength::Strengths& strengths);
  std::span<const float, kCount> values() const { return values_; }

 private:
  static constexpr std::size_t kMemory = 24;
  struct Hop {
    std::array<float, kBands> loudness{};
    std::array<float, kTones> tones{};
    std::array<float, kOnsetGroups> strengths{};
  };

  const Hop& before(std::size_t hops) const;
  void read();

  std::vector<std::size_t> band_of_bin_;  // kBands: none
  std::vector<std::size_t> row_of_tone_;  // kTones: none
  std::array<float, kBands> level_{};
  std::array<Hop, kMemory> ring_{};
  std::array<float, kCount> values_{};
  std::size_t newest_ = 0;
  std::size_t hops_ = 0;
};

}  // namespace dance

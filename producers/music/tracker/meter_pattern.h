// MeterPattern: where in a bar of four beats a kind of music strikes, in each group of onset
// strengths: salsa has its bass before the beat and its bells on it, rock the drum on each second
// beat, swing its thirds. They decide which of
// the evenly spaced strokes are beats.
//
// Units/frames: weights are relative within a row; tempi in beats a minute.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
// Source:       patterns in a bar pointer model follow Krebs, Böck and Widmer, "Rhythmic pattern
//               modeling for beat and downbeat tracking in musical audio", ISMIR 2013. The weights
//               are means over songs: research/beats/music_training.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "producers/music/tracker/onset_strength.h"

namespace dance {

constexpr std::size_t kPatternBeats = 4;
// Where in a beat a pattern has weights.
constexpr std::array kPatternPlaces_beats{0.0, 1.0 / 4, 1.0 / 3, 1.0 / 2, 2.0 / 3, 3.0 / 4};
constexpr std::size_t kPatternSlots = kPatternBeats * kPatternPlaces_beats.size();

struct MeterPattern {
  int least_tempo_bpm;
  int most_tempo_bpm;
  std::array<std::array<std::uint8_t, kPatternSlots>, kOnsetGroups> weights;
};

}  // namespace dance

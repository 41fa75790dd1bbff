// Makes songs of a style: which layers they have, their chords, tempo, breaks and fills are drawn;
// so are the small errors of those who play. Their beats are known exactly.
//
// Units/frames: seconds from the begin; keys, programs and loudness as in General MIDI; channel 9
//               is the drums.
// Ownership:    plain values.
// Threads:      const calls may run at the same time.
// Failure:      none; the same seed makes the same song.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "research/beats/make/song_style.h"

namespace dance {

struct SongNote {
  double start_s = 0.0;
  double length_s = 0.0;
  int channel = 0;
  int key = 0;
  int loudness = 0;
};

struct MadeSong {
  static constexpr int kDrumChannel = 9;

  double tempo_bpm = 0.0;
  std::array<int, 16> programs{};
  std::vector<SongNote> notes;
  std::vector<double> beats_s;  // bars of four
};

// What a song is for: to be taught, or to judge a tracker that has not heard its like.
enum class SongUse {
  kTaught,
  kMixed,  // taught too; half of the songs borrow layers, drums and instruments from other styles
  kKeptBack,  // rows and instruments that taught songs never have, and mixed ones seldom
};

MadeSong make_song(const SongStyle& style, double seconds, std::uint64_t seed,
                   SongUse use = SongUse::kTaught);
// A file of type 0.
std::vector<std::uint8_t> write_midi(const MadeSong& song);

}  // namespace dance

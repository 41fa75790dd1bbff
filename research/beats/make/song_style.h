// SongStyle: what a kind of dance music is made of, as rows of strokes; song_styles.toml has them
// and says what a row means.
//
// Units/frames: a row is one bar of four beats or two, a letter a sixteenth.
// Ownership:    constants.
// Threads:      const calls may run at the same time.
// Failure:      none: the file is built in, and a test reads it.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace dance {

enum class SongVoice { kDrums, kBass, kKeys, kGuitar, kDistorted, kBrass, kLead, kPad };

struct SongLayer {
  SongVoice voice;
  double chance;                          // that a song has it
  int loudness;                           // of 127
  double length_beats;                    // of a tone
  std::vector<std::array<int, 3>> drums;  // one of these; keys of General MIDI
  std::vector<int> programs;              // one of these; none: one of the voice's
  std::vector<std::string> rows;          // one of these
  std::vector<std::string> kept_rows;     // of songs that are kept back; none: the same ones
};

struct SongStyle {
  std::string name;
  double least_tempo_bpm;
  double most_tempo_bpm;
  bool is_steady;      // played to a machine; else its tempo may wander, swell or step
  double least_swing;  // where in a beat its half is
  double most_swing;
  std::vector<SongLayer> layers;
};

// In the order in which `dance music make` draws its seeds.
const std::vector<SongStyle>& song_styles();

}  // namespace dance

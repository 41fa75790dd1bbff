// SongStyle: what a kind of dance music is made of, as rows of strokes: enough for songs from which
// a beat tracker learns, whose beats are known because they were made on them.
//
// Units/frames: a row is one bar of four beats or two, a letter a sixteenth: '.' nothing; drums: x
//               y z the first, second or third drum, X Y Z louder, o p softer; tones: 1 3 5 8 of
//               the chord, n the next bar's root, c all of the chord, r any of it. Bars are told
//               apart by '|'.
// Ownership:    constants.
// Threads:      const calls may run at the same time.
// Failure:      none.
#pragma once

#include <array>
#include <string_view>
#include <vector>

namespace dance {

enum class SongVoice { kDrums, kBass, kKeys, kGuitar, kDistorted, kBrass, kLead, kPad };

struct SongLayer {
  SongVoice voice;
  double chance;                          // that a song has it
  int loudness;                           // of 127
  double length_beats;                    // of a tone
  std::vector<std::array<int, 3>> drums;  // one of these; keys of General MIDI
  std::vector<std::string_view> rows;     // one of these
};

struct SongStyle {
  std::string_view name;
  double least_tempo_bpm;
  double most_tempo_bpm;
  bool is_steady;      // played to a machine; else its tempo may wander, swell or step
  double least_swing;  // where in a beat its half is
  double most_swing;
  std::vector<SongLayer> layers;
};

const std::vector<SongStyle>& latin_styles();
const std::vector<SongStyle>& other_styles();

}  // namespace dance

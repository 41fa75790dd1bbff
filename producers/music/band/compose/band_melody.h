// Melodies of the house band. A tune is made of motifs: a rhythm of two bars and the steps from
// note to note. A phrase of eight bars states a motif, repeats it on the next chords, answers it
// with another, and comes to rest. Strong beats have tones of the chord.
//
// Units/frames: keys are MIDI's.
#pragma once

#include <array>
#include <string_view>

#include "producers/music/band/compose/band_patterns.h"

namespace dance {

// Rhythms of two bars, an x for each note, as in band_patterns.h: motifs, and how phrases end.
struct BandRhythms {
  std::array<std::string_view, 6> motifs;
  std::array<std::string_view, 3> closes;
};

struct BandTune {
  BandVoice voice = BandVoice::kTrumpet;
  int low_key = 60;
  int high_key = 79;
  int velocity = 92;
  const BandRhythms* rhythms = nullptr;
  // The same purpose has the same tune; of another round the answers differ.
  std::uint32_t purpose = 0;
  int round = 0;
  // Players who join in a third and a sixth below, if any.
  std::array<BandVoice, 2> below{};
  int below_count = 0;
};

void write_tune(BandWriter& writer, BandSpan span, const BandTune& tune);
// Calls of two bars by the first, answers of two bars by the second, always the same.
void write_call_and_answer(BandWriter& writer, BandSpan span, const BandTune& call,
                           const BandTune& answer);
// One motif of two bars, over and over on the chords as they come.
void write_riff(BandWriter& writer, BandSpan span, const BandTune& tune);

}  // namespace dance

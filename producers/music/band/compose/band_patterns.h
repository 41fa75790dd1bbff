// Patterns that the players of the house band repeat bar after bar, as strings of one letter an
// eighth: rhythms that follow the harmony.
//
// Units/frames: a dot rests and a dash holds the note before it. A string is repeated until
//               the span ends.
#pragma once

#include <string_view>

#include "producers/music/band/compose/band_writer.h"

namespace dance {

struct BandSpan {
  int begin = 0;  // ticks
  int end = 0;
};

// The part's groove, without its break.
BandSpan groove_of(const BandWriter& writer, const BandPart& part);

// The whole part but for the last bar of the song: players who keep the beat play on in breaks.
BandSpan beat_of(const BandWriter& writer, const BandPart& part);

// 1 root, 3 third, 5 fifth, 7 the fourth tone or the fifth, 8 octave, n next bar's root, a half a
// tone below that.
void write_bass(BandWriter& writer, BandSpan span, BandVoice voice, std::string_view pattern,
                int lowest, int velocity);
// x: a chord of `count` tones from `lowest` upwards; X: louder.
void write_chords(BandWriter& writer, BandSpan span, BandVoice voice, std::string_view pattern,
                  int lowest, int count, int velocity);
// 1 is the lowest chord tone from `lowest` on, 2 the one above it, and so on; with `octaves` each
// sounds with its octave.
void write_arpeggio(BandWriter& writer, BandSpan span, BandVoice voice, std::string_view pattern,
                    int lowest, int velocity, bool octaves = false);
// Whole bars.
void write_pad(BandWriter& writer, BandSpan span, BandVoice voice, int lowest, int count,
               int velocity);
// Chords of some players together, in the breaks by the pattern, and the last bar of the song.
void write_stops(BandWriter& writer, std::string_view pattern, std::span<const BandVoice> voices);

}  // namespace dance

// The form of a song: its parts from the intro to the ending, drawn from the style and the seed. It
// does not depend on the tempo.
#pragma once

#include <cstdint>
#include <vector>

#include "producers/music/band/band_song.h"

namespace dance {

enum class BandPartKind : std::uint8_t { kIntro, kVerse, kChorus, kRiff, kSolo, kEnding };

struct BandPart {
  BandPartKind kind = BandPartKind::kVerse;
  int first_bar = 0;
  int bars = 0;                // even, as patterns are of two bars
  int round = 0;               // counts the parts of this kind from 0
  bool ends_in_break = false;  // the last bar: the band stops together
};

std::vector<BandPart> band_form(BandStyle style, std::uint32_t seed);

}  // namespace dance

// The chord loops of the house band's styles.
#pragma once

#include <array>
#include <span>

#include "producers/music/band/compose/band_harmony.h"

namespace dance {

// It lasts `halves` half bars; 0 in places that a loop does not use.
struct BandLoopChord {
  int step;  // of its root, from the tonic
  BandChordKind kind;
  int halves = 2;
};

struct BandLoop {
  bool minor;
  std::array<BandLoopChord, 8> chords;
};

struct BandLoops {
  std::span<const BandLoop> verse, chorus;
};

BandLoops loops_of(BandStyle style);

}  // namespace dance

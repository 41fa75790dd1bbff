// Place, loudness and General MIDI instrument of each player of the house band.
#pragma once

#include <cstdint>

#include "producers/music/band/band_note.h"

namespace dance {

struct BandPlayer {
  std::uint8_t program = 0;   // of percussion: the drum kit
  std::uint8_t volume = 100;  // as the MIDI controller: 127 is the loudest
  std::uint8_t pan = 64;      // 0 left, 64 middle, 127 right
};

const BandPlayer& player_of(BandVoice voice);

}  // namespace dance

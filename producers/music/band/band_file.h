// Bars of the house band as a file of music with the list of its beats beside it.
//
// Failure:      write_band_file() names the file and the reason.
#pragma once

#include <string>

#include "core/base/result.h"
#include "producers/music/band/band_audio.h"

namespace dance {

struct BandExcerpt {
  int first_bar = 0;
  int bars = 0;
  int channels = 2;  // 1 or 2
};

// song.wav in 16 bit, and song.beats.
Result<void> write_band_file(const std::string& wav, BandAudio& audio, const BandExcerpt& excerpt);

}  // namespace dance

// The music of a demo without --music: eight bars of the house band's salsa, on the band's own
// percussion, with the list of their beats beside them.
//
// Units/frames: a beat is what dancers count, eight of them to the clave; the file begins with the
//               first of a bar. Tempi are those of the band (producers/music/band/band_song.h).
// Failure:      write_demo_song() names the file and the reason.
#pragma once

#include <string>

#include "core/base/result.h"

namespace dance {

constexpr int kDemoSong_hz = 48000;
constexpr int kDemoSong_beats = 32;  // then it begins anew

// song.wav, one channel of 16 bit, and song.beats beside it.
Result<void> write_demo_song(const std::string& wav, double tempo_bpm);

}  // namespace dance

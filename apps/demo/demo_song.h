// The music of a demo that was given none: claves, cowbell, congas and maracas of a salsa, made by
// rule, with the list of its beats beside it.
//
// Units/frames: a beat is what dancers count, eight of them to the clave; the file begins with the
//               first of a bar.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      write_demo_song() names the file and the reason.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace dance {

constexpr int kDemoSong_hz = 22050;
constexpr int kDemoSong_beats = 32;  // then it begins anew

// Samples of one round, 16 bit, one channel.
std::vector<std::int16_t> demo_song(double tempo_bpm);
// song.wav, and song.beats beside it.
Result<void> write_demo_song(const std::string& wav, double tempo_bpm);

}  // namespace dance

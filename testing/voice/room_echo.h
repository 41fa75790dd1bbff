// A loudspeaker in a room, as a microphone there hears it: the direct sound and many reflections
// that fade, each at its own time; and by how much an echo was made quieter.
//
// Units/frames: samples at 48 kHz; ratios in dB.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/time.h"

namespace dance {

struct RoomEcho {
  Duration delay = Duration::ms(35);           // of loudspeaker, air and microphone
  Duration reverberation = Duration::ms(250);  // until reflections are 60 dB down
  double loudness = 0.5;                       // of all of it, against what is played
  std::uint64_t seed = 1;
};

std::vector<float> heard_in_room(std::span<const float> played, const RoomEcho& room);

double power_ratio_db(std::span<const float> before, std::span<const float> after);

}  // namespace dance

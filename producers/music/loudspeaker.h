// This machine's default sound output.
//
// Units/frames: the latency is the one that the server reports while sound plays.
// Ownership:    plain values.
// Threads:      call from main; takes half a second, in which silence is played.
// Failure:      an Error tells why there is none; a build without sound always fails.
#pragma once

#include <string>

#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

struct Loudspeaker {
  std::string name;  // as the sound server's own tools take it
  std::string description;
  bool is_muted = false;
  bool leads_nowhere = false;  // made by the server where it found no device
  Duration latency;
};

Result<Loudspeaker> default_loudspeaker(const std::string& program);

}  // namespace dance

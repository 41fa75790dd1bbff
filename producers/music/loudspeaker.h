// Where this machine's sound goes: the loudspeaker that the sound server gives to a program that
// names none.
//
// Units/frames: the latency is what the server knows of, from its hands to the air, while something
//               plays.
// Ownership:    plain values.
// Threads:      call from main; takes half a second, in which silence is played.
// Failure:      says why there is none, as a build without sound does.
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

// This machine's default microphone, as the sound server knows it.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      call from main; waits for the server's answer, a few seconds at most.
// Failure:      an Error tells why there is none.
#pragma once

#include <string>

#include "core/base/result.h"

namespace dance {

struct Microphone {
  std::string name;  // as the sound server's own tools take it
  std::string description;
  bool is_muted = false;
  bool is_monitor = false;  // what a sink plays: a server without a microphone takes that
};

Result<Microphone> default_microphone(const std::string& program);

}  // namespace dance

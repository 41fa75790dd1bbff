// The text of a refusal of the room's state, as tests of rooms compare it.
#pragma once

#include <string>

#include "tunnel/wire/wire_state.h"

namespace dance {

inline std::string refused_state(wire::StateKind kind, wire::StateVerdict verdict) {
  const char* name = kind == wire::StateKind::kMusic  ? "music"
                     : kind == wire::StateKind::kSong ? "song"
                                                      : "scene";
  return std::string(name) +
         (verdict == wire::StateVerdict::kOverruled ? " overruled" : " not allowed");
}

}  // namespace dance

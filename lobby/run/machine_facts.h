// What there is on this machine for a dancer to choose from: programs that were built, avatars,
// addresses.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      the drawing thread.
// Failure:      what is not there is an empty list.
#pragma once

#include "lobby/screen/lobby_model.h"

namespace dance {

// Once, at the start.
void find_parts(LobbyModel& model);
// Networks may come and go.
void find_addresses(LobbyModel& model);

// "/home/alice/x" → "~/x", as a shell takes it.
std::string with_tilde(const std::string& path);

}  // namespace dance

// What there is on this machine for a dancer to choose from: programs that were built, avatars,
// addresses.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      the drawing thread.
// Failure:      what is not there is an empty list.
#pragma once

#include "core/program/child_process.h"
#include "lobby/screen/lobby_model.h"

namespace dance {

// Once, at the start.
void find_parts(LobbyModel& model);
// Networks may come and go.
void find_addresses(LobbyModel& model);

// Sets headset_error from the active OpenXR runtime. No vendor's code is loaded.
void find_headset(LobbyModel& model);
// Returns the folders with recordings; the folder of new ones comes first.
std::vector<std::string> recording_folders();

// Shows a folder in the file manager.
Result<ChildProcess> open_folder(const std::string& folder);

// "/home/alice/x" → "~/x", as a shell takes it.
std::string with_tilde(const std::string& path);

}  // namespace dance

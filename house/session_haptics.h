// Reads [[haptics]] of a session file: what a guest of the house feels, and by which device.
//
// Units/frames: as haptics/haptic_table.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      the reader keeps what is wrong, with its place.
#pragma once

#include "house/session.h"
#include "house/toml_reader.h"

namespace dance {

void read_haptics(TomlReader& reader, HouseConfig& session);

// The words of `dance haptics` for what a session says.
std::vector<std::string> haptics_arguments(const HostedHaptics& haptics, const std::string& bus);

}  // namespace dance

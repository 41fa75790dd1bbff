// Reads [[produce]] of a session file: who dances in the house, before a camera, from a file, from
// another program or by a generator.
//
// Units/frames: as in session.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      the reader keeps what is wrong, with its place.
#pragma once

#include <filesystem>

#include "house/session.h"
#include "house/toml_reader.h"

namespace dance {

// Files are in the session file's folder.
void read_producer(TomlReader& reader, const std::filesystem::path& folder, HouseConfig& session);

}  // namespace dance

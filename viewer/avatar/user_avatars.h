// The avatars on this machine, for an AvatarLibrary: this user's store, what came from other houses
// into it, and those that ship with the program. What comes from the store is a stranger's: its
// hash is checked again, and read_avatar() checks all the rest.
//
// Ownership: what it returns owns what it needs.
// Threads:   read_hash and read_file may run in any thread.
// Failure:   of a file: named, with the reason.
#pragma once

#include <string>
#include <vector>

#include "core/store/avatar_store.h"
#include "viewer/avatar/avatar_library.h"

namespace dance {

AvatarLibraryOptions avatars_of(const AvatarStore& store, const std::string& shipped_folder,
                                std::vector<AvatarOverride> overrides);

// "me.vrm", "alice=me.vrm", or a shipped avatar's name instead of a file. Says why such a file
// could not be shown.
Result<AvatarOverride> parse_avatar_override(const std::string& text,
                                             const std::string& shipped_folder);

}  // namespace dance

// Where keys lie on a machine, and how they get there: files that only their owner may read,
// replaced whole, so that nobody ever finds half of one.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      any; two programs may write at once, and one of them wins.
// Failure:      each says which file, why, and the cure.
#pragma once

#include <optional>
#include <string>

#include "core/base/result.h"
#include "tunnel/seal/house_keys.h"
#include "tunnel/seal/key_ring.h"

namespace dance {

// $XDG_CONFIG_HOME/dance, or ~/.config/dance.
Result<std::string> key_folder();

// Refuses what others may read. nullopt: there is no such file.
Result<std::optional<std::string>> read_secret(const std::string& path);
Result<void> write_secret(const std::string& path, const std::string& text);

// The key between programs on this machine, made by the first that needs it.
constexpr const char* kLocalKeyName = "local";
Result<PresharedKey> local_key();

// A server's keys, without those of this machine; an empty ring where there is no file.
Result<KeyRing> load_server_keys(const std::string& path);
// The same, with the local key.
Result<KeyRing> with_local_key(KeyRing ring);

}  // namespace dance

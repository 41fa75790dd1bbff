// The delivery of a key or an invitation that is shown once: where it cannot be written, the key is
// revoked again, as nobody has it.
//
// Failure: an Error names the cause, and whether the key was revoked.
#pragma once

#include <string>

#include "core/base/result.h"
#include "tunnel/server/program/key_store.h"

namespace dance {

// `delivered`: whether the secret of `name`, which the store holds already, was written.
Result<void> keep_or_revoke(const Result<void>& delivered, const std::string& name,
                            KeyStore& store);

}  // namespace dance

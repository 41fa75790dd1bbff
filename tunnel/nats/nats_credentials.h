// A NATS user's credentials file, as `nsc generate creds` writes it: a JWT, and the seed of the key
// that proves who shows it.
//
// Units/frames: none.
// Ownership:    plain values; the seed is read anew each time, and wiped.
// Threads:      any; reads a file.
// Failure:      a file that cannot be read, or holds something else, is named with its option.
#pragma once

#include <string>

#include "core/base/result.h"

namespace dance {

struct NatsProof {
  std::string jwt;
  std::string signature;  // of the server's nonce, base64 for URLs
};
Result<NatsProof> prove_nats_user(const std::string& path, const std::string& nonce);

}  // namespace dance

// Why a link has no sealed session.
//
// Threads: none inside.
// Failure: none.
#pragma once

#include <cstdint>

namespace dance {

enum class SealTrouble : std::uint8_t {
  kNoAnswer,          // nothing has come back
  kWrongKey,          // the server is there, and has no such key for this name
  kNotTrusted,        // no common cipher, or a certificate that one of both does not trust
  kInterrupted,       // it answered, and then no more
  kServerKeyChanged,  // it names another key than the one that this house knows
};

}  // namespace dance

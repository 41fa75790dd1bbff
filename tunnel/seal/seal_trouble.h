// Why a link has no sealed session.
//
// Threads: none inside.
// Failure: none.
#pragma once

#include <cstdint>

namespace dance {

enum class SealTrouble : std::uint8_t {
  kNoAnswer,          // nothing has arrived from the server
  kWrongKey,          // the server answers, but knows another key or none for this name
  kNotTrusted,        // no common cipher, or a certificate that one side does not trust
  kInterrupted,       // it answered, then fell silent
  kServerKeyChanged,  // its key is not the one that this house knows
};

}  // namespace dance

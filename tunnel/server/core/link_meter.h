// What has passed between the server and one link since the link's first datagram in its session.
//
// Units/frames: datagrams, and bytes of them as the state machine sees them.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/time.h"

namespace dance {

struct LinkMeter {
  MonoTime since;  // not set = nothing has come since the hello: perhaps nobody is there
  std::uint64_t datagrams_in = 0;
  std::uint64_t bytes_in = 0;
  std::uint64_t datagrams_out = 0;
  std::uint64_t bytes_out = 0;

  void came_in(std::size_t bytes, MonoTime now) {
    if (!since.is_set()) since = now;
    ++datagrams_in;
    bytes_in += bytes;
  }
  void went_out(std::size_t bytes) {
    ++datagrams_out;
    bytes_out += bytes;
  }
};

}  // namespace dance

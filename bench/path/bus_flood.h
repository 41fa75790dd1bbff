// Hostile datagrams for a bus, as any program of this machine could send them: fragments with
// wrapping offsets, datagrams without a NUL, noise, made-up channels, and garbage on pose channels.
//
// Ownership: runs until a signal ends its process.
// Failure:   returns only after an error, and returns that error.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/result.h"

namespace dance {

// Sends `rate_hz` datagrams a second, to each of the ports in turn.
Error flood_buses(std::span<const std::uint16_t> ports, double rate_hz);

}  // namespace dance

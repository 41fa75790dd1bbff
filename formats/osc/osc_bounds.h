// has_sound_bounds: whether every size in a datagram of Open Sound Control keeps within it. It is
// asked before the library reads: oscpack 1.1.0 adds sizes in 32 bits without asking whether they
// fit, so a bundle's element of -4 bytes ends where it begins, and reading never ends; and a blob
// of nearly 4 GiB puts what follows it before the datagram.
//
// Units/frames: none.
// Ownership:    a view of the caller's bytes.
// Threads:      none inside.
// Failure:      false, for bundles nested deeper than most_depth too.
// Source:       Open Sound Control 1.0 specification.
#pragma once

#include <cstdint>
#include <span>

namespace dance {

bool has_sound_bounds(std::span<const std::uint8_t> packet, int most_depth);

}  // namespace dance

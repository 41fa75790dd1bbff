// Pixels as a PNG file.
//
// Units/frames: 8-bit sRGB, rows from the top without gaps; alpha is not multiplied in.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      pixels that are not as many as the size says, or when memory is short.
// Source:       libpng.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"

namespace dance {

Result<std::vector<std::uint8_t>> png_of_rgb(int width_px, int height_px,
                                             std::span<const std::uint8_t> rgb);

// Without alpha where all is opaque.
Result<std::vector<std::uint8_t>> png_of_rgba(int width_px, int height_px,
                                              std::span<const std::uint8_t> rgba);

}  // namespace dance

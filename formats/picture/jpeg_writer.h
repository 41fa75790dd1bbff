// Pixels as a JPEG file, with half the colours' resolution as cameras write it.
//
// Units/frames: 8-bit sRGB, rows from the top without gaps; quality 1 to 100 as libjpeg counts it.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      pixels that are not as many as the size says, or when memory is short.
// Source:       libjpeg-turbo.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"

namespace dance {

Result<std::vector<std::uint8_t>> jpeg_of_rgb(int width_px, int height_px,
                                              std::span<const std::uint8_t> rgb, int quality);

}  // namespace dance

// An avatar's picture as a PNG file.
//
// Units/frames: as AvatarPicture: rows from the top, 8-bit sRGB; without alpha where all is opaque.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      png_of() of a picture without size, or when memory is short, says so.
// Source:       libpng.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "formats/avatar/avatar_model.h"

namespace dance {

Result<std::vector<std::uint8_t>> png_of(const AvatarPicture& picture);

}  // namespace dance

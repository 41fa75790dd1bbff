// How a picture has to be turned to stand upright, as the camera that took it noted in it: the
// orientation of Exif, in a JPEG or a PNG.
//
// Units/frames: 1 to 8 as Exif has it: where row 0 and column 0 of the pixels are in the scene.
// Ownership:    plain values.
// Threads:      none inside; pure.
// Failure:      1 (as it is) where nothing is noted, or what cannot be read; reads no byte beyond
//               the given ones, whatever they are.
// Source:       Exif 2.32 (CIPA DC-008), TIFF 6.0 section 2, PNG third edition (chunk eXIf).
#pragma once

#include <cstdint>
#include <span>

namespace dance {

int exif_orientation(std::span<const std::uint8_t> bytes);

}  // namespace dance

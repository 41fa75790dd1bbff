// Picture: pixels in memory, and the PNG file they become.
//
// Units/frames: RGB, 8 bit, sRGB; rows from the top.
// Ownership:    owns its pixels.
// Threads:      none inside.
// Failure:      write_png() names the file and the reason.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/assert.h"
#include "core/base/result.h"

namespace dance {

struct Picture {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgb;

  std::array<int, 3> at(int x_px, int y_px) const {
    DANCE_ASSERT(x_px >= 0 && x_px < width_px && y_px >= 0 && y_px < height_px, x_px, y_px);
    const std::size_t i = 3 * (static_cast<std::size_t>(y_px) * static_cast<std::size_t>(width_px) +
                               static_cast<std::size_t>(x_px));
    return {rgb[i], rgb[i + 1], rgb[i + 2]};
  }
};

// The pixels of the framebuffer that is bound for reading.
Picture read_bound_framebuffer(int width_px, int height_px);

// Moments side by side in one picture; all of one height.
Picture side_by_side(std::span<const Picture> pictures);

Picture one_above_the_other(std::span<const Picture> pictures);  // all of one width

Result<void> write_png(const std::string& file, const Picture& picture);

}  // namespace dance

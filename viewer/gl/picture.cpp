#include "viewer/gl/picture.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "formats/picture/png_writer.h"

namespace dance {

Picture read_bound_framebuffer(int width_px, int height_px) {
  const std::size_t row = 3 * static_cast<std::size_t>(width_px);
  std::vector<std::uint8_t> upside_down(row * static_cast<std::size_t>(height_px));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_px, height_px, GL_RGB, GL_UNSIGNED_BYTE, upside_down.data());
  Picture picture{width_px, height_px, std::vector<std::uint8_t>(upside_down.size())};
  for (std::size_t y = 0; y < static_cast<std::size_t>(height_px); ++y)
    std::memcpy(picture.rgb.data() + y * row,
                upside_down.data() + (static_cast<std::size_t>(height_px) - 1 - y) * row, row);
  return picture;
}

Picture side_by_side(std::span<const Picture> pictures) {
  Picture strip;
  for (const Picture& picture : pictures) {
    DANCE_ASSERT(picture.height_px == pictures.front().height_px, picture.height_px);
    strip.width_px += picture.width_px;
    strip.height_px = picture.height_px;
  }
  strip.rgb.reserve(3 * static_cast<std::size_t>(strip.width_px) *
                    static_cast<std::size_t>(strip.height_px));
  for (int y = 0; y < strip.height_px; ++y) {
    for (const Picture& picture : pictures) {
      const std::ptrdiff_t row = 3 * static_cast<std::ptrdiff_t>(picture.width_px);
      const auto begin = picture.rgb.begin() + y * row;
      strip.rgb.insert(strip.rgb.end(), begin, begin + row);
    }
  }
  return strip;
}

Picture one_above_the_other(std::span<const Picture> pictures) {
  Picture tall;
  for (const Picture& picture : pictures) {
    DANCE_ASSERT(picture.width_px == pictures.front().width_px, picture.width_px);
    tall.width_px = picture.width_px;
    tall.height_px += picture.height_px;
    tall.rgb.insert(tall.rgb.end(), picture.rgb.begin(), picture.rgb.end());
  }
  return tall;
}

Result<void> write_png(const std::string& file, const Picture& picture) {
  DANCE_TRY(const auto png, png_of_rgb(picture.width_px, picture.height_px, picture.rgb));
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  out.close();
  if (out) return {};
  return fail("cannot write " + file + ": " + std::strerror(errno) +
              "; choose another directory with --out");
}

}  // namespace dance

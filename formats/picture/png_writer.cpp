#include "formats/picture/png_writer.h"

#include <png.h>

#include <cstring>
#include <string>

#include "core/base/printable.h"

namespace dance {
namespace {

bool has_size(int width_px, int height_px, std::size_t channels, std::size_t bytes) {
  return width_px > 0 && height_px > 0 &&
         bytes ==
             channels * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
}

Result<std::vector<std::uint8_t>> written(int width_px, int height_px, png_uint_32 format,
                                          const std::uint8_t* rows) {
  png_image image;
  std::memset(&image, 0, sizeof image);
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_px);
  image.height = static_cast<png_uint_32>(height_px);
  image.format = format;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<std::uint8_t> file(size);
  if (!png_image_write_to_memory(&image, file.data(), &size, 0, rows, 0, nullptr)) {
    const std::string why = printable(image.message);
    png_image_free(&image);
    return fail("a picture cannot be written as PNG: " + why);
  }
  file.resize(size);
  return file;
}

}  // namespace

Result<std::vector<std::uint8_t>> png_of_rgb(int width_px, int height_px,
                                             std::span<const std::uint8_t> rgb) {
  if (!has_size(width_px, height_px, 3, rgb.size())) return fail("a picture has no size");
  return written(width_px, height_px, PNG_FORMAT_RGB, rgb.data());
}

Result<std::vector<std::uint8_t>> png_of_rgba(int width_px, int height_px,
                                              std::span<const std::uint8_t> rgba) {
  if (!has_size(width_px, height_px, 4, rgba.size())) return fail("a picture has no size");
  for (std::size_t i = 3; i < rgba.size(); i += 4)
    if (rgba[i] != 255) return written(width_px, height_px, PNG_FORMAT_RGBA, rgba.data());
  std::vector<std::uint8_t> rgb;
  rgb.reserve(rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < rgba.size(); i += 4)
    rgb.insert(rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
  return written(width_px, height_px, PNG_FORMAT_RGB, rgb.data());
}

}  // namespace dance

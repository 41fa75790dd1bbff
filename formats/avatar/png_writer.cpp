#include "formats/avatar/png_writer.h"

#include <png.h>

#include <cstring>

namespace dance {

Result<std::vector<std::uint8_t>> png_of(const AvatarPicture& picture) {
  const std::size_t pixels =
      static_cast<std::size_t>(picture.width_px) * static_cast<std::size_t>(picture.height_px);
  if (picture.width_px <= 0 || picture.height_px <= 0 || picture.rgba.size() != 4 * pixels)
    return fail("a picture of an avatar has no size");
  bool is_opaque = true;
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4)
    is_opaque = is_opaque && picture.rgba[i] == 255;
  std::vector<std::uint8_t> rgb;
  if (is_opaque)
    for (std::size_t i = 0; i < pixels; ++i)
      rgb.insert(rgb.end(), &picture.rgba[4 * i], &picture.rgba[4 * i] + 3);
  png_image image;
  std::memset(&image, 0, sizeof image);
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width_px);
  image.height = static_cast<png_uint_32>(picture.height_px);
  image.format = is_opaque ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  const std::uint8_t* rows = is_opaque ? rgb.data() : picture.rgba.data();
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<std::uint8_t> file(size);
  if (!png_image_write_to_memory(&image, file.data(), &size, 0, rows, 0, nullptr)) {
    const std::string why = image.message;
    png_image_free(&image);
    return fail("a picture of an avatar cannot be written as PNG: " + why);
  }
  file.resize(size);
  return file;
}

}  // namespace dance

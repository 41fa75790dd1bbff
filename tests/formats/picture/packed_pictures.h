// Pictures of three kinds, packed by the libraries' own encoders: red grows to the right, green
// downwards, blue is 128, all opaque.
//
// Ownership: plain values.
// Threads:   none inside.
// Failure:   an encoder that fails is a failed assertion.
#pragma once

#include <png.h>
#include <turbojpeg.h>
#include <webp/encode.h>

#include <cstdint>
#include <vector>

#include "core/base/assert.h"

namespace dance::test {

inline std::vector<std::uint8_t> ramp(int width_px, int height_px, std::uint8_t alpha = 255) {
  std::vector<std::uint8_t> rgba;
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x)
      rgba.insert(rgba.end(), {static_cast<std::uint8_t>(255 * x / width_px),
                               static_cast<std::uint8_t>(255 * y / height_px), 128, alpha});
  return rgba;
}

inline std::vector<std::uint8_t> png(int width_px, int height_px, std::uint8_t alpha = 255) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_px);
  image.height = static_cast<png_uint_32>(height_px);
  image.format = PNG_FORMAT_RGBA;
  const auto rgba = ramp(width_px, height_px, alpha);
  png_alloc_size_t size = 0;
  DANCE_ASSERT(png_image_write_get_memory_size(image, size, 0, rgba.data(), 0, nullptr));
  std::vector<std::uint8_t> bytes(size);
  DANCE_ASSERT(png_image_write_to_memory(&image, bytes.data(), &size, 0, rgba.data(), 0, nullptr));
  bytes.resize(size);
  return bytes;
}

inline std::vector<std::uint8_t> jpeg(int width_px, int height_px, int flags = 0) {
  const auto rgba = ramp(width_px, height_px);
  unsigned char* packed = nullptr;
  unsigned long size = 0;
  tjhandle handle = tjInitCompress();
  DANCE_ASSERT(tjCompress2(handle, rgba.data(), width_px, 0, height_px, TJPF_RGBA, &packed, &size,
                           TJSAMP_444, 95, flags) == 0);
  std::vector<std::uint8_t> bytes(packed, packed + size);
  tjFree(packed);
  tjDestroy(handle);
  return bytes;
}

inline std::vector<std::uint8_t> webp(int width_px, int height_px) {
  const auto rgba = ramp(width_px, height_px);
  std::uint8_t* packed = nullptr;
  const std::size_t size =
      WebPEncodeLosslessRGBA(rgba.data(), width_px, height_px, width_px * 4, &packed);
  DANCE_ASSERT(size > 0);
  std::vector<std::uint8_t> bytes(packed, packed + size);
  WebPFree(packed);
  return bytes;
}

// Exif data that note this orientation, behind another note.
inline std::vector<std::uint8_t> exif(std::uint8_t orientation, bool is_little) {
  if (is_little)
    return {'I', 'I', 42, 0,    8, 0, 0, 0, 2, 0, 0x0f, 0x01,        2, 0, 1, 0, 0, 0, 'x',
            0,   0,   0,  0x12, 1, 3, 0, 1, 0, 0, 0,    orientation, 0, 0, 0, 0, 0, 0, 0};
  return {'M', 'M', 0, 42, 0,    0, 0, 8, 0, 2, 0x01, 0x0f, 0,           2, 0, 0, 0, 1, 'x',
          0,   0,   0, 1,  0x12, 0, 3, 0, 0, 0, 1,    0,    orientation, 0, 0, 0, 0, 0, 0};
}

inline std::vector<std::uint8_t> with_exif(std::vector<std::uint8_t> picture,
                                           const std::vector<std::uint8_t>& note) {
  std::vector<std::uint8_t> part;
  std::ptrdiff_t at = 2;  // behind the beginning of the JPEG
  if (picture[0] == 0xff) {
    const auto length = static_cast<std::uint8_t>(note.size() + 8);
    part = {0xff, 0xe1, 0, length, 'E', 'x', 'i', 'f', 0, 0};
    part.insert(part.end(), note.begin(), note.end());
  } else {
    at = 8 + 25;  // behind the first chunk of the PNG
    part = {0, 0, 0, static_cast<std::uint8_t>(note.size()), 'e', 'X', 'I', 'f'};
    part.insert(part.end(), note.begin(), note.end());
    part.insert(part.end(), 4, 0);
  }
  picture.insert(picture.begin() + at, part.begin(), part.end());
  return picture;
}

}  // namespace dance::test

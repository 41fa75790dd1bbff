// Pictures of others, decoded with bounds: PNG, JPEG and WebP, told by their first bytes. The size
// that the header tells is checked before a pixel is decoded or memory for it is taken.
//
// Units/frames: 8 bits each of red, green, blue (sRGB) and alpha (linear, not multiplied in); rows
//               from the top.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      read_picture() says what is wrong; never throws on any bytes.
// Source:       PNG by libpng, JPEG by libjpeg-turbo, WebP by libwebp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"

namespace dance {

struct RgbaPicture {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgba;
};

struct PictureLimits {
  int side_px = 4096;
  std::size_t decoded_bytes = std::size_t{1} << 26;  // 4096 × 4096
  int reduced_side_px = 1024;                        // larger pictures are made smaller
};

enum class PictureKind : std::uint8_t { kNone, kPng, kJpeg, kWebp };
PictureKind picture_kind(std::span<const std::uint8_t> bytes);

Result<RgbaPicture> read_picture(std::span<const std::uint8_t> bytes,
                                 const PictureLimits& limits = {});

// How many bytes it takes to decode the picture, by its header; 0 where that cannot be read.
std::size_t decoded_bytes(std::span<const std::uint8_t> bytes);

// The picture with its sides divided by a whole number, so that none is longer than `side_px`: each
// pixel the mean of a square, in which transparent pixels count less.
RgbaPicture reduced(RgbaPicture picture, int side_px);

}  // namespace dance

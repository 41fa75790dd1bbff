// The three decoders behind read_picture(), each in two steps: the size by the header, then the
// pixels into memory that was taken for that size.
//
// Ownership: plain values.
// Threads:   none inside.
// Failure:   names what is wrong.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/result.h"
#include "formats/picture/picture.h"

namespace dance {

struct PictureSize {
  int width_px = 0;
  int height_px = 0;
};

// One format.
class PictureDecoder {
 public:
  virtual ~PictureDecoder() = default;
  virtual Result<PictureSize> size(std::span<const std::uint8_t> bytes) const = 0;
  // Into width × height × 4 bytes of the size that the header tells.
  virtual Result<void> decode(std::span<const std::uint8_t> bytes, PictureSize size,
                              std::span<std::uint8_t> rgba) const = 0;
};

const PictureDecoder& png_decoder();
const PictureDecoder& jpeg_decoder();
const PictureDecoder& webp_decoder();

}  // namespace dance

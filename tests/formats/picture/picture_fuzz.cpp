// libFuzzer target: any bytes through the three picture decoders, and the search for how a picture
// has to be turned.
#include <cstddef>
#include <cstdint>

#include "core/base/assert.h"
#include "formats/picture/orientation.h"
#include "formats/picture/picture.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(picture_reader) {
  dance::PictureLimits limits;
  limits.side_px = 256;
  limits.decoded_bytes = std::size_t{4} * 256 * 256;
  limits.reduced_side_px = 64;
  const int orientation = dance::exif_orientation(std::span(data, size));
  DANCE_ASSERT(orientation >= 1 && orientation <= 8, orientation);
  const auto picture = dance::read_picture(std::span(data, size), limits);
  if (!picture) {
    for (const char c : picture.error().what) DANCE_ASSERT(c >= 0x20 && c < 0x7f, c);
    return 0;
  }
  DANCE_ASSERT(picture->width_px > 0 && picture->width_px <= 64, picture->width_px);
  DANCE_ASSERT(picture->height_px > 0 && picture->height_px <= 64, picture->height_px);
  DANCE_ASSERT(picture->rgba.size() == std::size_t{4} *
                                           static_cast<std::size_t>(picture->width_px) *
                                           static_cast<std::size_t>(picture->height_px));
  return 0;
}

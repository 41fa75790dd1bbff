// What a camera sends is read as it comes: five bytes of layout, then the bytes of a picture.
#include <linux/videodev2.h>

#include <array>
#include <cstdint>

#include "core/base/assert.h"
#include "producers/camera/v4l2/picture_converter.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(picture) {
  using namespace dance;
  constexpr std::array<std::uint32_t, 5> kEncodings{V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_NV12,
                                                    V4L2_PIX_FMT_MJPEG, V4L2_PIX_FMT_GREY,
                                                    V4L2_PIX_FMT_JPEG};
  constexpr std::size_t kLayout_bytes = 5;
  if (size < kLayout_bytes) return 0;
  const PixelLayout layout{kEncodings[data[0] % kEncodings.size()], data[1], data[2], data[3]};
  auto converter = PictureConverter::make(layout, data[4]);
  if (!converter) return 0;
  cv::Mat picture;
  const bool is_whole = converter->convert({data + kLayout_bytes, size - kLayout_bytes}, picture);
  // A picture never grows over what was agreed, but for the last block of a JPEG.
  DANCE_ASSERT(picture.rows < layout.height_px + 16 && picture.cols < layout.width_px + 16);
  DANCE_ASSERT(!is_whole || !picture.empty());
  return 0;
}

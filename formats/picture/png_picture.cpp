#include <png.h>

#include <limits>
#include <string>

#include "core/base/printable.h"
#include "formats/picture/picture_codecs.h"

namespace dance {
namespace {

// libpng's own bounds of chunks (8 MB each) hold for what is packed beside the pixels.
class PngReading {
 public:
  explicit PngReading(std::span<const std::uint8_t> bytes) {
    image_.version = PNG_IMAGE_VERSION;
    is_begun_ = png_image_begin_read_from_memory(&image_, bytes.data(), bytes.size()) != 0;
  }
  PngReading(const PngReading&) = delete;
  PngReading& operator=(const PngReading&) = delete;
  ~PngReading() { png_image_free(&image_); }

  bool is_begun() const { return is_begun_; }
  png_image& image() { return image_; }
  Error error() const { return {"a PNG that cannot be read: " + printable(image_.message)}; }

 private:
  png_image image_{};
  bool is_begun_ = false;
};

class PngDecoder final : public PictureDecoder {
 public:
  Result<PictureSize> size(std::span<const std::uint8_t> bytes) const override {
    PngReading reading(bytes);
    if (!reading.is_begun()) return tl::make_unexpected(reading.error());
    constexpr auto kMost = static_cast<png_uint_32>(std::numeric_limits<int>::max());
    if (reading.image().width > kMost || reading.image().height > kMost)
      return fail("a PNG with a broken size");
    return PictureSize{static_cast<int>(reading.image().width),
                       static_cast<int>(reading.image().height)};
  }

  Result<void> decode(std::span<const std::uint8_t> bytes, PictureSize size,
                      std::span<std::uint8_t> rgba) const override {
    PngReading reading(bytes);
    if (!reading.is_begun()) return tl::make_unexpected(reading.error());
    reading.image().format = PNG_FORMAT_RGBA;
    if (PNG_IMAGE_SIZE(reading.image()) != rgba.size()) return fail("a PNG with two sizes");
    if (png_image_finish_read(&reading.image(), nullptr, rgba.data(), size.width_px * 4, nullptr) ==
        0)
      return tl::make_unexpected(reading.error());
    return {};
  }
};

}  // namespace

const PictureDecoder& png_decoder() {
  static const PngDecoder decoder;
  return decoder;
}

}  // namespace dance

#include <png.h>

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/printable.h"
#include "formats/picture/picture_codecs.h"

namespace dance {
namespace {

// What belongs to the pixels, without the rest: libpng takes memory for a chunk by the length that
// the file tells, up to 2 GB (its bound of 8 MB is only a warning where pictures are read in this
// way), and unpacks a thousand texts of 8 MB each. Empty where a chunk is longer than the bytes
// that are left, or the last one is missing.
std::vector<std::uint8_t> chunks_of_pixels(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kSignature = 8, kHead = 8, kSum = 4;
  constexpr std::string_view kKept = "IHDR PLTE tRNS gAMA sRGB cHRM sBIT IDAT IEND";
  std::vector<std::uint8_t> kept;
  if (bytes.size() < kSignature) return kept;
  kept.reserve(bytes.size());
  kept.assign(bytes.begin(), bytes.begin() + kSignature);
  bytes = bytes.subspan(kSignature);
  while (bytes.size() >= kHead + kSum) {
    const std::size_t length = std::size_t{bytes[0]} << 24 | std::size_t{bytes[1]} << 16 |
                               std::size_t{bytes[2]} << 8 | std::size_t{bytes[3]};
    if (length > bytes.size() - kHead - kSum) break;
    const auto chunk = bytes.first(kHead + length + kSum);
    const std::string name(chunk.begin() + 4, chunk.begin() + 8);
    if (name.find(' ') == std::string::npos && kKept.find(name) != std::string_view::npos)
      kept.insert(kept.end(), chunk.begin(), chunk.end());
    if (name == "IEND") return kept;
    bytes = bytes.subspan(chunk.size());
  }
  kept.clear();
  return kept;
}

class PngReading {
 public:
  explicit PngReading(std::span<const std::uint8_t> bytes) : bytes_(chunks_of_pixels(bytes)) {
    image_.version = PNG_IMAGE_VERSION;
    is_begun_ = !bytes_.empty() &&
                png_image_begin_read_from_memory(&image_, bytes_.data(), bytes_.size()) != 0;
  }
  PngReading(const PngReading&) = delete;
  PngReading& operator=(const PngReading&) = delete;
  ~PngReading() { png_image_free(&image_); }

  bool is_begun() const { return is_begun_; }
  png_image& image() { return image_; }
  Error error() const {
    const std::string what = bytes_.empty() ? "it ends within a chunk" : printable(image_.message);
    return {"a PNG that cannot be read: " + what};
  }

 private:
  std::vector<std::uint8_t> bytes_;
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

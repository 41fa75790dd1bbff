#include <turbojpeg.h>

#include <algorithm>
#include <memory>
#include <string>

#include "core/base/printable.h"
#include "formats/picture/picture_codecs.h"

namespace dance {
namespace {

struct Destroy {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, Destroy>;

// A progressive JPEG of a few kilobytes may have hundreds of scans over all its pixels. Common ones
// have ten, which this allows for the largest picture.
constexpr std::size_t kMostScans = 16;
constexpr std::size_t kLargePixels = std::size_t{1} << 24;  // smaller ones may have more scans

// As a decoder finds them, marker by marker up to the end of the image: what segments hold (a
// thumbnail), and what stands behind the image (a telephone's film), are no scans of it.
std::size_t scans(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kFirstRestart = 0xd0, kStart = 0xd8, kEnd = 0xd9, kScan = 0xda;
  std::size_t count = 0;
  for (std::size_t i = 1; i < bytes.size();) {
    const std::uint8_t marker = bytes[i - 1] == 0xff ? bytes[i] : 0;
    const bool is_pixels = marker == 0 || marker == 0xff || marker == 0x01;
    if (is_pixels || (marker >= kFirstRestart && marker <= kStart)) {
      ++i;
      continue;
    }
    if (marker == kEnd || i + 2 >= bytes.size()) break;
    if (marker == kScan) ++count;
    i += 2 + std::size_t{bytes[i + 1]} * 256 + bytes[i + 2];
  }
  return count;
}

class JpegDecoder final : public PictureDecoder {
 public:
  Result<PictureSize> size(std::span<const std::uint8_t> bytes) const override {
    const Handle handle(tjInitDecompress());
    if (!handle) return fail("no memory for a JPEG");
    PictureSize size;
    int subsampling = 0;
    int colour_space = 0;
    if (tjDecompressHeader3(handle.get(), bytes.data(), static_cast<unsigned long>(bytes.size()),
                            &size.width_px, &size.height_px, &subsampling, &colour_space) != 0)
      return tl::make_unexpected(error_of(handle));
    return size;
  }

  Result<void> decode(std::span<const std::uint8_t> bytes, PictureSize size,
                      std::span<std::uint8_t> rgba) const override {
    const Handle handle(tjInitDecompress());
    if (!handle) return fail("no memory for a JPEG");
    const std::size_t pixels = rgba.size() / 4;
    if (scans(bytes) * pixels > kMostScans * std::max(pixels, kLargePixels))
      return fail("a JPEG of many scans");
    if (tjDecompress2(handle.get(), bytes.data(), static_cast<unsigned long>(bytes.size()),
                      rgba.data(), size.width_px, size.width_px * 4, size.height_px, TJPF_RGBA,
                      TJFLAG_LIMITSCANS | TJFLAG_STOPONWARNING) != 0)
      return tl::make_unexpected(error_of(handle));
    return {};
  }

 private:
  static Error error_of(const Handle& handle) {
    return {"a JPEG that cannot be read: " + printable(tjGetErrorStr2(handle.get()))};
  }
};

}  // namespace

const PictureDecoder& jpeg_decoder() {
  static const JpegDecoder decoder;
  return decoder;
}

}  // namespace dance

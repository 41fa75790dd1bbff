#include <webp/decode.h>

#include "formats/picture/picture_codecs.h"

namespace dance {
namespace {

class WebpDecoder final : public PictureDecoder {
 public:
  Result<PictureSize> size(std::span<const std::uint8_t> bytes) const override {
    WebPBitstreamFeatures features{};
    if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK)
      return fail("a WebP that cannot be read");
    if (features.has_animation) return fail("a WebP that is a film");
    return PictureSize{features.width, features.height};
  }

  Result<void> decode(std::span<const std::uint8_t> bytes, PictureSize size,
                      std::span<std::uint8_t> rgba) const override {
    if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), rgba.data(), rgba.size(),
                            size.width_px * 4))
      return fail("a WebP that is damaged");
    return {};
  }
};

}  // namespace

const PictureDecoder& webp_decoder() {
  static const WebpDecoder decoder;
  return decoder;
}

}  // namespace dance

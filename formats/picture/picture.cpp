#include "formats/picture/picture.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "formats/picture/picture_codecs.h"

namespace dance {
namespace {

constexpr std::size_t kChannels = 4;

bool begins_with(std::span<const std::uint8_t> bytes, std::string_view text, std::size_t at = 0) {
  return bytes.size() >= at + text.size() &&
         std::memcmp(bytes.data() + at, text.data(), text.size()) == 0;
}

const PictureDecoder* decoder_of(PictureKind kind) {
  switch (kind) {
    case PictureKind::kPng:
      return &png_decoder();
    case PictureKind::kJpeg:
      return &jpeg_decoder();
    case PictureKind::kWebp:
      return &webp_decoder();
    case PictureKind::kNone:
      break;
  }
  return nullptr;
}

std::size_t bytes_of(PictureSize size) {
  return kChannels * static_cast<std::size_t>(size.width_px) *
         static_cast<std::size_t>(size.height_px);
}

// The mean of a square that may reach beyond the right and lower edge.
std::array<std::uint8_t, kChannels> mean(const RgbaPicture& picture, int left, int top, int side) {
  std::array<std::uint64_t, 3> colour{};
  std::array<std::uint64_t, 3> weighted{};
  std::uint64_t alpha = 0;
  std::uint64_t count = 0;
  for (int y = top; y < std::min(top + side, picture.height_px); ++y)
    for (int x = left; x < std::min(left + side, picture.width_px); ++x) {
      const std::uint8_t* pixel =
          picture.rgba.data() +
          kChannels * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width_px) +
                       static_cast<std::size_t>(x));
      for (std::size_t c = 0; c < 3; ++c) {
        colour[c] += pixel[c];
        weighted[c] += pixel[c] * std::uint64_t{pixel[3]};
      }
      alpha += pixel[3];
      ++count;
    }
  std::array<std::uint8_t, kChannels> out{};
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = static_cast<std::uint8_t>(alpha > 0 ? (weighted[c] + alpha / 2) / alpha
                                                 : (colour[c] + count / 2) / count);
  out[3] = static_cast<std::uint8_t>((alpha + count / 2) / count);
  return out;
}

}  // namespace

PictureKind picture_kind(std::span<const std::uint8_t> bytes) {
  if (begins_with(bytes, "\x89PNG\r\n\x1a\n")) return PictureKind::kPng;
  if (begins_with(bytes, "\xff\xd8\xff")) return PictureKind::kJpeg;
  if (begins_with(bytes, "RIFF") && begins_with(bytes, "WEBP", 8)) return PictureKind::kWebp;
  return PictureKind::kNone;
}

Result<RgbaPicture> read_picture(std::span<const std::uint8_t> bytes, const PictureLimits& limits) {
  const PictureDecoder* decoder = decoder_of(picture_kind(bytes));
  if (!decoder) return fail("a picture that is neither PNG nor JPEG nor WebP");
  DANCE_TRY(const PictureSize size, decoder->size(bytes));
  if (size.width_px < 1 || size.height_px < 1) return fail("a picture without pixels");
  const std::string what = "a picture of " + std::to_string(size.width_px) + " x " +
                           std::to_string(size.height_px) + " pixels; make it smaller than ";
  if (size.width_px > limits.side_px || size.height_px > limits.side_px)
    return fail(what + std::to_string(limits.side_px) + " a side");
  if (bytes_of(size) > limits.decoded_bytes)
    return fail(what + std::to_string(limits.decoded_bytes / 4'000'000) + " megapixels");
  RgbaPicture picture{size.width_px, size.height_px, {}};
  picture.rgba.resize(bytes_of(size));
  if (auto decoded = decoder->decode(bytes, size, picture.rgba); !decoded)
    return tl::make_unexpected(decoded.error());
  return reduced(std::move(picture), limits.reduced_side_px);
}

std::size_t decoded_bytes(std::span<const std::uint8_t> bytes) {
  const PictureDecoder* decoder = decoder_of(picture_kind(bytes));
  if (!decoder) return 0;
  const auto size = decoder->size(bytes);
  if (!size || size->width_px < 1 || size->height_px < 1) return 0;
  return bytes_of(*size);
}

RgbaPicture reduced(RgbaPicture picture, int side_px) {
  const int longest = std::max(picture.width_px, picture.height_px);
  if (side_px < 1 || longest <= side_px) return picture;
  const int square = (longest + side_px - 1) / side_px;
  RgbaPicture out{
      (picture.width_px + square - 1) / square, (picture.height_px + square - 1) / square, {}};
  out.rgba.reserve(bytes_of({out.width_px, out.height_px}));
  for (int y = 0; y < out.height_px; ++y)
    for (int x = 0; x < out.width_px; ++x) {
      const auto pixel = mean(picture, x * square, y * square, square);
      out.rgba.insert(out.rgba.end(), pixel.begin(), pixel.end());
    }
  return out;
}

}  // namespace dance

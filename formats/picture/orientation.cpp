#include "formats/picture/orientation.h"

#include <cstddef>
#include <cstring>
#include <string_view>

#include "formats/picture/picture.h"

namespace dance {
namespace {

using ExifBytes = std::span<const std::uint8_t>;

constexpr int kUpright = 1;
constexpr std::uint16_t kOrientationTag = 0x0112;
constexpr std::uint16_t kShortType = 3;
constexpr std::size_t kEntry_bytes = 12;
constexpr std::size_t kMostEntries = 256;
constexpr std::size_t kPngSignature_bytes = 8;

bool has_at(ExifBytes bytes, std::size_t at, std::size_t count) {
  return at <= bytes.size() && count <= bytes.size() - at;
}

bool says(ExifBytes bytes, std::size_t at, std::string_view text) {
  return has_at(bytes, at, text.size()) &&
         std::memcmp(bytes.data() + at, text.data(), text.size()) == 0;
}

std::uint32_t number(ExifBytes bytes, std::size_t at, std::size_t count, bool is_little) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value = value << 8 | bytes[at + (is_little ? count - 1 - i : i)];
  return value;
}

// The first directory of the TIFF file that Exif data are.
int orientation_in_tiff(ExifBytes tiff) {
  const bool is_little = says(tiff, 0, "II");
  if ((!is_little && !says(tiff, 0, "MM")) || !has_at(tiff, 0, 8)) return kUpright;
  const std::size_t directory = number(tiff, 4, 4, is_little);
  if (!has_at(tiff, directory, 2)) return kUpright;
  const std::size_t entries = number(tiff, directory, 2, is_little);
  for (std::size_t i = 0; i < entries && i < kMostEntries; ++i) {
    const std::size_t entry = directory + 2 + i * kEntry_bytes;
    if (!has_at(tiff, entry, kEntry_bytes)) break;
    if (number(tiff, entry, 2, is_little) != kOrientationTag) continue;
    if (number(tiff, entry + 2, 2, is_little) != kShortType) break;
    const auto value = static_cast<int>(number(tiff, entry + 8, 2, is_little));
    return value >= 1 && value <= 8 ? value : kUpright;
  }
  return kUpright;
}

// Segments: 0xff, kind, length of two bytes that counts itself. The pixels begin behind 0xffda.
int orientation_in_jpeg(ExifBytes bytes) {
  constexpr std::size_t kFirstSegment = 2;
  for (std::size_t at = kFirstSegment; has_at(bytes, at, 4) && bytes[at] == 0xff;) {
    const std::uint8_t kind = bytes[at + 1];
    if (kind == 0xff) {  // filling
      ++at;
      continue;
    }
    if (kind == 0xda || kind == 0xd9) break;
    const std::size_t length = number(bytes, at + 2, 2, false);
    if (length < 2 || !has_at(bytes, at + 2, length)) break;
    constexpr std::string_view kExif("Exif\0\0", 6);
    const ExifBytes inside = bytes.subspan(at + 4, length - 2);
    if (kind == 0xe1 && says(inside, 0, kExif))
      return orientation_in_tiff(inside.subspan(kExif.size()));
    at += 2 + length;
  }
  return kUpright;
}

// Chunks: length of what is inside, kind, inside, checksum.
int orientation_in_png(ExifBytes bytes) {
  for (std::size_t at = kPngSignature_bytes; has_at(bytes, at, 12);) {
    const std::size_t length = number(bytes, at, 4, false);
    if (!has_at(bytes, at + 8, length) || says(bytes, at + 4, "IEND")) break;
    if (says(bytes, at + 4, "eXIf")) return orientation_in_tiff(bytes.subspan(at + 8, length));
    at += 12 + length;
  }
  return kUpright;
}

}  // namespace

int exif_orientation(std::span<const std::uint8_t> bytes) {
  switch (picture_kind(bytes)) {
    case PictureKind::kJpeg:
      return orientation_in_jpeg(bytes);
    case PictureKind::kPng:
      return orientation_in_png(bytes);
    case PictureKind::kWebp:
    case PictureKind::kNone:
      break;
  }
  return kUpright;
}

}  // namespace dance

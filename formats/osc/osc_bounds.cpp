#include "formats/osc/osc_bounds.h"

#include <cstddef>
#include <string_view>

#include "core/base/byte_reader.h"

namespace dance {
namespace {

constexpr std::size_t kBundleBegin_bytes = 16;

std::size_t rounded_up_to_4(std::size_t n) { return (n + 3) & ~std::size_t{3}; }

std::size_t size_of(ByteReader& in) {
  std::size_t size = 0;
  for (int i = 0; i < 4; ++i) size = size << 8 | in.u8();
  return size;
}

// A text ends with one to four zeros. The library looks at every fourth byte alone: where one that
// should be zero is not, it reads on.
bool pass_text(ByteReader& in, std::string_view& text) {
  text = in.text_to_zero(in.remaining());
  for (std::size_t n = text.size() + 1; n % 4 != 0; ++n)
    if (in.u8() != 0) return false;
  return in.ok();
}

bool pass_argument(char type, ByteReader& in) {
  std::string_view text;
  switch (type) {
    case 'i':
    case 'f':
    case 'c':
    case 'r':
    case 'm':
      in.bytes(4);
      break;
    case 'h':
    case 't':
    case 'd':
      in.bytes(8);
      break;
    case 's':
    case 'S':
      return pass_text(in, text);
    case 'b':
      in.bytes(rounded_up_to_4(size_of(in)));
      break;
    default:
      break;  // without bytes, or unknown: the library refuses what it does not know
  }
  return in.ok();
}

bool has_sound_arguments(std::span<const std::uint8_t> message) {
  ByteReader in(message);
  std::string_view address, types;
  if (!pass_text(in, address)) return false;
  if (in.remaining() == 0) return true;
  if (!pass_text(in, types)) return false;
  for (const char type : types)
    if (!pass_argument(type, in)) return false;
  return true;
}

bool has_sound_elements(std::span<const std::uint8_t> element, int depth_left) {
  if (element.empty() || element.size() % 4 != 0) return false;
  if (element[0] == '/') return has_sound_arguments(element);
  if (element[0] != '#' || element.size() < kBundleBegin_bytes || depth_left == 0) return false;
  ByteReader in(element.subspan(kBundleBegin_bytes));
  while (in.ok() && in.remaining() > 0) {
    const std::size_t bytes = size_of(in);
    const auto inner = in.bytes(bytes);
    if (!in.ok() || !has_sound_elements(inner, depth_left - 1)) return false;
  }
  return in.ok();
}

}  // namespace

bool has_sound_bounds(std::span<const std::uint8_t> packet, int most_depth) {
  return has_sound_elements(packet, most_depth);
}

}  // namespace dance

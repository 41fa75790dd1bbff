#include "core/bus/datagram.h"

#include <algorithm>
#include <cstring>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr std::size_t kHeaderBytes = 8;
// Magic, sequence, message size, offset (32 bits each), fragment number, fragments (16 bits each).
constexpr std::size_t kFragmentHeaderBytes = 20, kFragmentNumberAt = 16;

std::uint32_t read_u32(std::span<const std::uint8_t> bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 |
         std::uint32_t{bytes[2]} << 8 | bytes[3];
}

void write_u32(std::uint32_t value, std::uint8_t* out) {
  for (int i = 0; i < 4; ++i) out[i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

// The NUL-terminated channel name at the front; "" where there is no valid one.
std::string_view leading_name(std::span<const std::uint8_t> bytes) {
  const auto front = bytes.first(std::min(bytes.size(), kMaxChannelLength + 1));
  const auto nul = std::find(front.begin(), front.end(), 0);
  if (nul == front.end()) return {};
  const std::string_view name(reinterpret_cast<const char*>(front.data()),
                              static_cast<std::size_t>(nul - front.begin()));
  return is_channel_name(name) ? name : std::string_view();
}

}  // namespace

bool is_channel_name(std::string_view name) {
  return !name.empty() && name.size() <= kMaxChannelLength &&
         std::all_of(name.begin(), name.end(), [](char c) { return c >= 0x20 && c < 0x7f; });
}

BusDatagram parse_datagram(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeaderBytes) return {};
  const std::uint32_t magic = read_u32(bytes);
  if (magic == kShortMessageMagic) {
    const std::string_view name = leading_name(bytes.subspan(kHeaderBytes));
    if (name.empty()) return {};
    return {BusDatagram::Kind::kMessage, name, bytes.subspan(kHeaderBytes + name.size() + 1)};
  }
  if (magic != kFragmentMagic || bytes.size() < kFragmentHeaderBytes) return {};
  // The first fragment alone carries the channel name.
  const bool is_first = bytes[kFragmentNumberAt] == 0 && bytes[kFragmentNumberAt + 1] == 0;
  return {BusDatagram::Kind::kFragment,
          is_first ? leading_name(bytes.subspan(kFragmentHeaderBytes)) : std::string_view(),
          {}};
}

DatagramHeader::DatagramHeader(std::uint32_t sequence, std::string_view name)
    : size(kHeaderBytes + name.size() + 1) {
  DANCE_ASSERT(is_channel_name(name), name.size());
  write_u32(kShortMessageMagic, bytes.data());
  write_u32(sequence, bytes.data() + 4);
  std::memcpy(bytes.data() + kHeaderBytes, name.data(), name.size());
  bytes[size - 1] = 0;
}

}  // namespace dance

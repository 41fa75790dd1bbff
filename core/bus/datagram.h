// Datagrams of LCM's UDP protocol. A short message is one datagram: "LC02", a sequence number, the
// channel name, NUL, the message. A longer message is split into "LC03" fragments, which this tree
// refuses: its own messages are shorter than 1,000 bytes.
//
// Units/frames: numbers are big-endian on the wire.
// Ownership:    a parsed datagram refers to the bytes it was parsed from.
// Source:       LCM's description of its UDP multicast protocol.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/bus/channel.h"

namespace dance {

constexpr std::uint32_t kShortMessageMagic = 0x4c433032;  // "LC02"
constexpr std::uint32_t kFragmentMagic = 0x4c433033;      // "LC03"
constexpr std::size_t kMaxDatagramBytes = 65'507;         // UDP's limit over IPv4

struct BusDatagram {
  enum class Kind {
    kMessage,
    kFragment,   // valid or not: of its fields only the name is read
    kMalformed,  // too short, unknown magic, no NUL within 64 bytes, a name with other characters
  };
  Kind kind = Kind::kMalformed;
  std::string_view name;               // of a message; of a fragment only where it carries one
  std::span<const std::uint8_t> data;  // of a message
};

BusDatagram parse_datagram(std::span<const std::uint8_t> bytes);

// Whether a channel may have this name: 1 to 63 printable ASCII characters.
bool is_channel_name(std::string_view name);

// Header in front of the message: magic, sequence number, name, NUL.
struct DatagramHeader {
  // Panics (our bug) on a name that is_channel_name() refuses.
  DatagramHeader(std::uint32_t sequence, std::string_view name);
  std::array<std::uint8_t, 8 + kMaxChannelLength + 1> bytes;
  std::size_t size;
};

}  // namespace dance

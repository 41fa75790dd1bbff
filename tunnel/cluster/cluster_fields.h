// What messages and values of a cluster are made of: inside cluster_format.cpp and
// cluster_values.cpp alone.
//
// Units/frames: as in cluster_format.h.
// Ownership:    views of the caller's bytes.
// Threads:      none inside.
// Failure:      false or nothing where bytes are not what they have to be.
#pragma once

#include <optional>
#include <span>
#include <variant>

#include "core/base/byte_reader.h"
#include "core/base/byte_writer.h"
#include "tunnel/cluster/cluster_format.h"

namespace dance::cluster {

enum class Type : std::uint8_t {
  kHeartbeat = 1,
  kClockQuestion = 2,
  kClockAnswer = 3,
  kRecord = 4,
  kFeedback = 5,  // 6: cluster_bundle.h
  kFile = 7,
  kVoice = 8,
  kRemoval = 9,
  kPresence = 16,
  kState = 18,  // 17: guests without their keys, no longer in use
  kGuest = 19,
};

// Captures lie within these, as in the wire format: nothing that is computed with them overflows.
constexpr std::int64_t kFarthest_us = std::int64_t{1} << 60;

inline void begin(Type type, ByteWriter& out) {
  out.u8(kClusterVersion);
  out.u8(static_cast<std::uint8_t>(type));
}

template <class Name>
void write_name(const Name& name, ByteWriter& out) {
  out.short_text(name.view());
}
// Not set where empty.
inline bool read_name(ByteReader& in, GuestId& name) {
  const std::string_view text = in.text(in.u8());
  if (!in.ok() || text.empty()) return in.ok();
  const auto parsed = GuestId::parse(text);
  if (parsed) name = *parsed;
  return parsed.has_value();
}
inline bool read_set_name(ByteReader& in, GuestId& name) {
  return read_name(in, name) && name.is_set();
}
inline bool read_server(ByteReader& in, ServerId& server) {
  server = in.u64();
  return server != 0;
}
inline bool is_near(std::int64_t us) { return us > -kFarthest_us && us < kFarthest_us; }

// By `write`, which puts one of them into a ByteWriter; 0 where there is no room.
template <class Any, class Write>
std::size_t build_any(const Any& any, std::span<std::uint8_t> buffer, const Write& write) {
  ByteWriter out(buffer);
  std::visit([&](const auto& one) { write(one, out); }, any);
  return out.ok() ? out.size() : 0;
}

// The type, of the version that this is.
inline std::optional<Type> opening(ByteReader& in) {
  const std::uint8_t version = in.u8();
  const auto type = static_cast<Type>(in.u8());
  if (!in.ok() || version != kClusterVersion) return std::nullopt;
  return type;
}

}  // namespace dance::cluster

// Values of a cluster's bucket.
#include "tunnel/cluster/cluster_fields.h"

namespace dance::cluster {
namespace {

void write(const PresenceValue& value, ByteWriter& out) {
  begin(Type::kPresence, out);
  out.u64(value.server);
  out.u8(value.has_host ? 1 : 0);
}
std::optional<Value> read_presence(ByteReader& in) {
  PresenceValue value;
  const bool is_good = read_server(in, value.server);
  const std::uint8_t has_host = in.u8();
  value.has_host = has_host == 1;
  if (!is_good || has_host > 1) return std::nullopt;
  return value;
}

void write(const GuestValue& value, ByteWriter& out) {
  begin(Type::kGuest, out);
  out.u64(value.server);
  out.u64(value.link_token);
  out.i64(value.since_us);
  out.u8(static_cast<std::uint8_t>(value.codec.id));
  out.u32(value.codec.model);
  write_name(value.key.name, out);
  out.u8(value.key.is_shared ? 1 : 0);
}
std::optional<Value> read_guest(ByteReader& in) {
  GuestValue value;
  const bool is_good = read_server(in, value.server);
  value.link_token = in.u64();
  value.since_us = in.i64();
  value.codec.id = static_cast<CodecId>(in.u8());
  value.codec.model = in.u32();
  if (!is_good || !is_near(value.since_us) || !read_name(in, value.key.name)) return std::nullopt;
  const std::uint8_t is_shared = in.u8();
  value.key.is_shared = is_shared == 1;
  if (is_shared > 1) return std::nullopt;
  return value;
}

void write(const StateValue& value, ByteWriter& out) {
  begin(Type::kState, out);
  out.u64(value.link_token);
  write_name(value.setter, out);
  out.u32(value.version);
  out.bytes(value.payload);
}
std::optional<Value> read_state(ByteReader& in) {
  StateValue value;
  value.link_token = in.u64();
  if (!read_name(in, value.setter)) return std::nullopt;
  value.version = in.u32();
  value.payload = in.bytes(in.remaining());
  if (!in.ok() || value.version == 0 || value.payload.size() > wire::kMaxStatePayload)
    return std::nullopt;
  return value;
}

}  // namespace

std::size_t build(const Value& value, std::span<std::uint8_t> out) {
  return build_any(value, out, [](const auto& one, ByteWriter& to) { write(one, to); });
}

std::optional<Value> parse_value(Bytes bytes) {
  ByteReader in(bytes);
  const auto type = opening(in);
  if (!type) return std::nullopt;
  std::optional<Value> value;
  switch (*type) {
    case Type::kPresence:
      value = read_presence(in);
      break;
    case Type::kGuest:
      value = read_guest(in);
      break;
    case Type::kState:
      value = read_state(in);
      break;
    default:
      return std::nullopt;
  }
  return in.is_exhausted() ? value : std::nullopt;
}

}  // namespace dance::cluster

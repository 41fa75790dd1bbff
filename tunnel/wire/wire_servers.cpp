#include "tunnel/wire/wire_servers.h"

namespace dance::wire {

void write_address(const Address& address, ByteWriter& out) {
  if (!address.is_set()) return out.u8(0);
  const std::size_t size = address.family() == Address::Family::kIpv4 ? 4 : 16;
  out.u8(static_cast<std::uint8_t>(size));
  out.bytes(std::span(address.ip()).first(size));
  out.u16(address.port());
}

bool read_address(ByteReader& in, Address& address) {
  const std::size_t size = in.u8();
  if (size == 0) return in.ok();
  if (size != 4 && size != 16) return false;
  const auto ip = in.bytes(size);
  const std::uint16_t port = in.u16();
  if (!in.ok() || port == 0) return false;
  address = Address::of(ip, port);
  return true;
}

std::size_t build(const ServerList& servers, std::span<std::uint8_t> buffer) {
  ByteWriter out(buffer);
  out.u8(static_cast<std::uint8_t>(Type::kServers));
  out.u8(static_cast<std::uint8_t>(servers.size()));
  for (const Address& server : servers) write_address(server, out);
  return out.ok() ? out.size() : 0;
}

std::optional<ServerList> parse_servers(Bytes body) {
  ByteReader in(body);
  const std::size_t count = in.u8();
  if (!in.ok() || count > kMaxServers) return std::nullopt;
  ServerList servers;
  for (std::size_t i = 0; i < count; ++i) {
    Address server;
    if (!read_address(in, server) || !server.is_set() || server.is_multicast() ||
        !servers.try_push(server))
      return std::nullopt;
  }
  if (!in.is_exhausted()) return std::nullopt;
  return servers;
}

}  // namespace dance::wire

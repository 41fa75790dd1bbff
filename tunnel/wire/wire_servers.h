// The other servers of a cluster, as a server tells its links: where they can go when it ends.
// Built and parsed; docs/wire-format.md says it byte by byte.
//
// Units/frames: addresses as guests reach them.
// Ownership:    plain values; nothing here allocates.
// Threads:      none inside.
// Failure:      as in tunnel/wire/wire.h.
#pragma once

#include "core/net/address.h"
#include "tunnel/wire/wire.h"

namespace dance::wire {

constexpr std::size_t kMaxServers = 16;
using ServerList = FixedList<Address, kMaxServers>;

// An address: 4 or 16, that many bytes of it, and the port; 0 alone where it is not set.
void write_address(const Address& address, ByteWriter& out);
bool read_address(ByteReader& in, Address& address);

// The whole datagram, opening included.
std::size_t build(const ServerList& servers, std::span<std::uint8_t> out);
std::optional<ServerList> parse_servers(Bytes body);

}  // namespace dance::wire

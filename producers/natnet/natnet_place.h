// Where NatNet is heard, as people write it:
//   239.255.42.99:1511                         the multicast group, on the system's interface
//   239.255.42.99:1511?interface=192.168.1.20  on the interface that has this address
//   0.0.0.0:1511?server=192.168.1.5            unicast: asks this server to send here
// and further, divided by &: server=HOST[:1510], version=3.1 (of a stream whose server does not
// answer), up=z (where Motive's up axis is set to Z).
//
// Ownership: plain values.
// Threads:   none inside. Resolving may wait for a name server.
// Failure:   parse_natnet_place() names the word and what is allowed.
#pragma once

#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/net/address.h"
#include "formats/natnet/natnet_packet.h"

namespace dance {

struct NatNetPlace {
  Address listen;     // a multicast group, or an address of this machine
  Address interface;  // of a group; not set: the system's choice
  Address server;     // its command port; not set: from where the stream comes
  std::optional<NatNetVersion> version;
  bool z_is_up = false;
};

constexpr const char* kUsualNatNetPlace = "239.255.42.99:1511";
constexpr std::uint16_t kNatNetDataPort = 1511;
constexpr std::uint16_t kNatNetCommandPort = 1510;

// "": the usual one.
Result<NatNetPlace> parse_natnet_place(const std::string& text);

}  // namespace dance

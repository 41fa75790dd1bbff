// An IPv4 or IPv6 address with its port, as a small comparable value: source or destination of a
// datagram. IPv4 through an IPv6 socket (::ffff:a.b.c.d) is kept as IPv4, so that one peer has one
// address.
//
// Units/frames: port in host order.
// Ownership:    plain value.
// Threads:      none inside. resolve() may wait for a name server: not for the pose path.
// Failure:      resolve() names what is wrong with the text and the cure.
#pragma once

#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dance {

class Address {
 public:
  enum class Family : std::uint8_t { kNone, kIpv4, kIpv6 };
  // The network from which an address can be reached, from the nearest to the widest.
  enum class Scope : std::uint8_t {
    kNone,      // no host: not set, 0.0.0.0, multicast, broadcast, reserved
    kMachine,   // loopback
    kLink,      // link-local
    kPrivate,   // of one site or provider: RFC 1918, 6598, 4193
    kInternet,  // all others
  };

  Address() = default;  // not set
  // "host:port", "1.2.3.4:7400", "[::1]:7400"; the port may be left out where default_port is not
  // 0.
  static Result<Address> resolve(std::string_view text, std::uint16_t default_port = 0);
  // All addresses of a name, at most 8, in the order in which the system would try them.
  static Result<std::vector<Address>> resolve_all(std::string_view text,
                                                  std::uint16_t default_port = 0);
  // Whether the host is an address, which needs no name server.
  static bool is_numeric(std::string_view text);
  static Address from_sockaddr(const sockaddr_storage& raw);
  // 4 or 16 bytes as they stand in a datagram's header; not set for any other number of them.
  static Address of(std::span<const std::uint8_t> ip, std::uint16_t port);
  static Address loopback(std::uint16_t port);
  static Address any_ipv4(std::uint16_t port);  // 0.0.0.0

  // Fills `raw` for a socket of the given family and returns its length. An IPv4 address is mapped
  // for an IPv6 socket; an IPv6 address has none on an IPv4 socket: 0.
  socklen_t to_sockaddr(Family socket_family, sockaddr_storage& raw) const;

  Family family() const { return family_; }
  std::uint16_t port() const { return port_; }
  Address with_port(std::uint16_t port) const;
  // The address of this machine that a datagram of this sender was sent to, in the form of ip();
  // all zero where that is not known. UdpSocket sends to such an Address from there.
  const std::array<std::uint8_t, 16>& asked_ip() const { return asked_ip_; }
  bool has_asked_ip() const { return asked_ip_ != std::array<std::uint8_t, 16>{}; }
  // `asked` is of the same family, its port is ignored; multicast addresses are no source.
  Address with_asked(const Address& asked) const;
  bool is_set() const { return family_ != Family::kNone; }
  bool is_loopback() const;
  bool is_multicast() const;
  Scope scope() const;
  // As they stand in a datagram's header, an IPv4 address in the first four.
  const std::array<std::uint8_t, 16>& ip() const { return ip_; }
  // The subscriber's prefix as a number: an IPv4 address, or the upper half of an IPv6 address.
  std::uint64_t network() const;
  std::string to_string() const;
  bool operator==(const Address&) const = default;

 private:
  std::array<std::uint8_t, 16> ip_{};
  std::array<std::uint8_t, 16> asked_ip_{};
  std::uint32_t scope_ = 0;  // interface of a link-local IPv6 address
  std::uint16_t port_ = 0;
  Family family_ = Family::kNone;
};

}  // namespace dance

#include "core/net/address.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>

namespace dance {
namespace {

constexpr std::array<std::uint8_t, 12> kMappedPrefix{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};

struct HostAndPort {
  std::string host;
  std::string port;
};

// The last colon parts host and port, except in a bare IPv6 address, which has several and no
// brackets.
std::optional<HostAndPort> split(std::string_view text) {
  if (text.starts_with('[')) {
    const auto close = text.find(']');
    if (close == std::string_view::npos) return std::nullopt;
    const std::string_view rest = text.substr(close + 1);
    if (!rest.empty() && !rest.starts_with(':')) return std::nullopt;
    return HostAndPort{std::string(text.substr(1, close - 1)),
                       std::string(rest.empty() ? rest : rest.substr(1))};
  }
  const auto colon = text.rfind(':');
  if (colon == std::string_view::npos) return HostAndPort{std::string(text), ""};
  if (text.find(':') != colon) return HostAndPort{std::string(text), ""};
  return HostAndPort{std::string(text.substr(0, colon)), std::string(text.substr(colon + 1))};
}

std::optional<std::uint16_t> parse_port(const std::string& text) {
  std::uint16_t port = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, port);
  if (error != std::errc() || stop != end || port == 0) return std::nullopt;
  return port;
}

}  // namespace

Result<Address> Address::resolve(std::string_view text, std::uint16_t default_port) {
  DANCE_TRY(const auto all, resolve_all(text, default_port));
  return all.front();
}

Result<std::vector<Address>> Address::resolve_all(std::string_view text,
                                                  std::uint16_t default_port) {
  const std::string whole(text);
  const auto parts = split(text);
  if (!parts || parts->host.empty())
    return fail("'" + whole + "' is not an address: write HOST:PORT, or [IPV6]:PORT");
  std::uint16_t port = default_port;
  if (!parts->port.empty() || default_port == 0) {
    const auto parsed = parse_port(parts->port);
    if (!parsed)
      return fail("'" + whole + "' has no valid port: write HOST:PORT with a port of 1 to 65535");
    port = *parsed;
  }
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(parts->host.c_str(), nullptr, &hints, &found);
  if (error != 0 || found == nullptr)
    return fail("host '" + parts->host + "' is unknown (" + gai_strerror(error) +
                "): check the spelling and the network");
  constexpr std::size_t kMost = 8;
  std::vector<Address> all;
  for (const addrinfo* each = found; each != nullptr && all.size() < kMost; each = each->ai_next) {
    sockaddr_storage raw{};
    std::memcpy(&raw, each->ai_addr, each->ai_addrlen);
    const Address address = from_sockaddr(raw).with_port(port);
    if (std::find(all.begin(), all.end(), address) == all.end()) all.push_back(address);
  }
  freeaddrinfo(found);
  return all;
}

bool Address::is_numeric(std::string_view text) {
  const auto parts = split(text);
  if (!parts) return false;
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST;
  addrinfo* found = nullptr;
  if (getaddrinfo(parts->host.c_str(), nullptr, &hints, &found) != 0) return false;
  freeaddrinfo(found);
  return true;
}

Address Address::from_sockaddr(const sockaddr_storage& raw) {
  Address address;
  if (raw.ss_family == AF_INET) {
    sockaddr_in v4{};
    std::memcpy(&v4, &raw, sizeof v4);
    address.family_ = Family::kIpv4;
    address.port_ = ntohs(v4.sin_port);
    std::memcpy(address.ip_.data(), &v4.sin_addr, 4);
  } else if (raw.ss_family == AF_INET6) {
    sockaddr_in6 v6{};
    std::memcpy(&v6, &raw, sizeof v6);
    address.port_ = ntohs(v6.sin6_port);
    if (std::memcmp(&v6.sin6_addr, kMappedPrefix.data(), kMappedPrefix.size()) == 0) {
      address.family_ = Family::kIpv4;
      std::memcpy(address.ip_.data(), v6.sin6_addr.s6_addr + kMappedPrefix.size(), 4);
    } else {
      address.family_ = Family::kIpv6;
      address.scope_ = v6.sin6_scope_id;
      std::memcpy(address.ip_.data(), &v6.sin6_addr, 16);
    }
  }
  return address;
}

Address Address::any_ipv4(std::uint16_t port) {
  Address address;
  address.family_ = Family::kIpv4;
  address.port_ = port;
  return address;
}

Address Address::of(std::span<const std::uint8_t> ip, std::uint16_t port) {
  Address address;
  if (ip.size() != 4 && ip.size() != 16) return address;
  std::copy(ip.begin(), ip.end(), address.ip_.begin());
  address.family_ = ip.size() == 4 ? Family::kIpv4 : Family::kIpv6;
  address.port_ = port;
  return address;
}

Address Address::loopback(std::uint16_t port) {
  Address address;
  address.family_ = Family::kIpv4;
  address.ip_[0] = 127;
  address.ip_[3] = 1;
  address.port_ = port;
  return address;
}

socklen_t Address::to_sockaddr(Family socket_family, sockaddr_storage& raw) const {
  if (socket_family == Family::kIpv4) {
    if (family_ != Family::kIpv4) return 0;
    sockaddr_in v4{};
    v4.sin_family = AF_INET;
    v4.sin_port = htons(port_);
    std::memcpy(&v4.sin_addr, ip_.data(), 4);
    std::memcpy(&raw, &v4, sizeof v4);
    return sizeof v4;
  }
  if (!is_set()) return 0;
  sockaddr_in6 v6{};
  v6.sin6_family = AF_INET6;
  v6.sin6_port = htons(port_);
  v6.sin6_scope_id = scope_;
  if (family_ == Family::kIpv4) {
    std::memcpy(v6.sin6_addr.s6_addr, kMappedPrefix.data(), kMappedPrefix.size());
    std::memcpy(v6.sin6_addr.s6_addr + kMappedPrefix.size(), ip_.data(), 4);
  } else {
    std::memcpy(v6.sin6_addr.s6_addr, ip_.data(), 16);
  }
  std::memcpy(&raw, &v6, sizeof v6);
  return sizeof v6;
}

Address Address::with_port(std::uint16_t port) const {
  Address address = *this;
  address.port_ = port;
  return address;
}

Address Address::with_asked(const Address& asked) const {
  Address address = *this;
  const bool is_source = asked.family_ == family_ && !asked.is_multicast();
  address.asked_ip_ = is_source ? asked.ip_ : std::array<std::uint8_t, 16>{};
  return address;
}

bool Address::is_loopback() const {
  if (family_ == Family::kIpv4) return ip_[0] == 127;
  std::array<std::uint8_t, 16> one{};
  one[15] = 1;
  return family_ == Family::kIpv6 && ip_ == one;
}

bool Address::is_multicast() const {
  return (family_ == Family::kIpv4 && (ip_[0] & 0xf0) == 0xe0) ||
         (family_ == Family::kIpv6 && ip_[0] == 0xff);
}

Address::Scope Address::scope() const {
  if (!is_set() || is_multicast()) return Scope::kNone;
  if (is_loopback()) return Scope::kMachine;
  const auto begins = [this](std::initializer_list<std::uint8_t> prefix) {
    return std::equal(prefix.begin(), prefix.end(), ip_.begin());
  };
  if (family_ == Family::kIpv4) {
    if (ip_[0] == 0 || ip_[0] >= 240) return Scope::kNone;
    if (begins({169, 254})) return Scope::kLink;
    const bool is_private = ip_[0] == 10 || begins({192, 168}) ||
                            (ip_[0] == 172 && (ip_[1] & 0xf0) == 16) ||
                            (ip_[0] == 100 && (ip_[1] & 0xc0) == 64);
    return is_private ? Scope::kPrivate : Scope::kInternet;
  }
  // An IPv4 address within an IPv6 address counts as that: 64:ff9b::/96 (NAT64), 2002::/16 (6to4).
  if (begins({0x00, 0x64, 0xff, 0x9b, 0, 0, 0, 0, 0, 0, 0, 0}))
    return of(std::span(ip_).subspan<12, 4>(), port_).scope();
  if (begins({0x20, 0x02})) return of(std::span(ip_).subspan<2, 4>(), port_).scope();
  if (begins({0, 0, 0, 0, 0, 0, 0, 0})) return Scope::kNone;
  if (ip_[0] == 0xfe && (ip_[1] & 0xc0) == 0x80) return Scope::kLink;
  const bool is_private = (ip_[0] & 0xfe) == 0xfc || (ip_[0] == 0xfe && (ip_[1] & 0xc0) == 0xc0);
  return is_private ? Scope::kPrivate : Scope::kInternet;
}

std::uint64_t Address::network() const {
  const std::size_t size = family_ == Family::kIpv4 ? 4 : 8;
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | ip_[i];
  return value;
}

std::string Address::to_string() const {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (family_ == Family::kNone) return "nobody";
  const bool v4 = family_ == Family::kIpv4;
  inet_ntop(v4 ? AF_INET : AF_INET6, ip_.data(), text.data(), text.size());
  const std::string ip(text.data());
  return (v4 ? ip : "[" + ip + "]") + ":" + std::to_string(port_);
}

}  // namespace dance

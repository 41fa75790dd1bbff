// The networks that contain an address, from the widest to the narrowest. One attacker often owns a
// whole IPv6 /48 (65,536 /64s) or an IPv4 /24, so limits per address alone do not hold.
#pragma once

#include <array>
#include <cstdint>

#include "core/net/address.h"

namespace dance {

struct NetworkLevels {
  // IPv6: /32, /48, /56, /64. IPv4: /16, /24, /32 and /32 again.
  static constexpr std::size_t kLevels = 4;
  std::array<std::uint64_t, kLevels> prefix{};

  static NetworkLevels of(const Address& address) {
    const std::uint64_t network = address.network();
    // No IPv6 /64 in use begins with 0:ffff, so the two families share one number space.
    constexpr std::uint64_t kIpv4 = 0xffff'0000'0000;
    const auto without_low = [network](int bits) { return network >> bits << bits; };
    if (address.family() == Address::Family::kIpv4)
      return {{kIpv4 | without_low(16), kIpv4 | without_low(8), kIpv4 | network, kIpv4 | network}};
    return {{without_low(32), without_low(16), without_low(8), network}};
  }
  std::uint64_t narrowest() const { return prefix[kLevels - 1]; }
};

// Maps a network to one of `places`. A secret keeps attackers from choosing whose place they share.
// Source: finaliser of SplitMix64.
constexpr std::size_t place_of_network(std::uint64_t prefix, std::uint64_t secret,
                                       std::size_t places) {
  std::uint64_t x = prefix ^ secret;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return (x ^ (x >> 31)) % places;
}

}  // namespace dance

// Networks from which a key was used lately: an IPv4 address or an IPv6 /64. A part of the server's
// handshakes is reserved for them, so that guests return during a flood of strangers. Each key
// keeps its newest few, so one key cannot push out the networks of others.
//
// Ownership: a table of fixed size; keys that hash to one place share it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>

#include "core/base/time.h"
#include "tunnel/seal/network_levels.h"

namespace dance {

class RecentNetworks {
 public:
  static constexpr Duration kLately = Duration::s(12 * 3600);

  explicit RecentNetworks(std::uint64_t secret) : secret_(secret) {}

  void note(std::string_view key, const Address& from, MonoTime now) {
    const std::uint64_t network = NetworkLevels::of(from).narrowest();
    Key& of = keys_[place_of_network(std::hash<std::string_view>()(key), secret_, keys_.size())];
    Entry* goes = &of.front();
    for (Entry& entry : of) {
      if (entry.at.is_set() && entry.network == network) {
        entry.at = now;
        return;
      }
      if (entry.at < goes->at) goes = &entry;
    }
    if (goes->at.is_set()) --counts_[count_place(goes->network)];
    ++counts_[count_place(network)];
    *goes = {network, now};
  }
  bool contains(const Address& from, MonoTime now) const {
    const std::uint64_t network = NetworkLevels::of(from).narrowest();
    if (counts_[count_place(network)] == 0) return false;  // nearly all strangers end here
    for (const Key& key : keys_)
      for (const Entry& entry : key)
        if (entry.at.is_set() && entry.network == network && now - entry.at < kLately) return true;
    return false;
  }

 private:
  struct Entry {
    std::uint64_t network = 0;
    MonoTime at;
  };
  using Key = std::array<Entry, 4>;
  std::size_t count_place(std::uint64_t network) const {
    return place_of_network(network, secret_, counts_.size());
  }

  std::uint64_t secret_;
  std::array<Key, 1024> keys_;
  // How many entries hash to a place: finds strangers without a search.
  std::array<std::uint16_t, 16'384> counts_{};
};

}  // namespace dance

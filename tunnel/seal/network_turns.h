// Fair turns among networks: who is served next, and who has to leave when all places are taken.
// Both go from the widest network to the narrowest, so 65,536 IPv6 /64s of one owner weigh as much
// as the one network of a newcomer.
//
// Ownership: tables of fixed size; networks that hash to one place share their last turn.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "tunnel/seal/network_levels.h"

namespace dance {

class NetworkTurns {
 public:
  explicit NetworkTurns(std::uint64_t secret) : secret_(secret) {}

  // The index of the entry whose networks have waited longest for a turn; the first of equal ones.
  // There must be one. `networks_of(i)` returns the networks of entry i of `count`, or nullptr to
  // leave it out.
  template <class NetworksOf>
  std::size_t next(std::size_t count, const NetworksOf& networks_of) const {
    std::array<std::uint64_t, NetworkLevels::kLevels> best;
    best.fill(std::numeric_limits<std::uint64_t>::max());
    std::size_t chosen = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const NetworkLevels* networks = networks_of(i);
      if (networks == nullptr) continue;
      std::array<std::uint64_t, NetworkLevels::kLevels> turns;
      for (std::size_t level = 0; level < turns.size(); ++level)
        turns[level] = last_[level][place(level, *networks)];
      if (!(turns < best)) continue;
      best = turns;
      chosen = i;
    }
    return chosen;
  }
  // Counts a turn of these networks.
  void serve(const NetworkLevels& networks) {
    ++turn_;
    for (std::size_t level = 0; level < NetworkLevels::kLevels; ++level)
      last_[level][place(level, networks)] = turn_;
  }

  // The most entries that oldest_of_most_crowded() can compare.
  static constexpr std::size_t kMostEntries = 512;
  // The first entry of the network that has most entries: of the fullest /32, within it of the
  // fullest /48, and so on. There must be an entry.
  std::size_t oldest_of_most_crowded(std::span<const NetworkLevels> entries) const;

 private:
  static constexpr std::size_t kPlaces = 1024;
  std::size_t place(std::size_t level, const NetworkLevels& networks) const {
    return place_of_network(networks.prefix[level], secret_, kPlaces);
  }

  std::uint64_t secret_;
  std::uint64_t turn_ = 0;
  // The number of the last turn, by level.
  std::array<std::array<std::uint64_t, kPlaces>, NetworkLevels::kLevels> last_{};
};

}  // namespace dance

#include "tunnel/seal/network_turns.h"

#include <algorithm>

#include "core/base/assert.h"

namespace dance {
namespace {

// Counts equal numbers without allocating.
class PrefixCounts {
 public:
  explicit PrefixCounts(std::uint64_t secret) : secret_(secret) {}
  // The new count.
  std::uint32_t add(std::uint64_t prefix) {
    std::size_t place = place_of_network(prefix, secret_, places_.size());
    while (places_[place].count > 0 && places_[place].prefix != prefix)
      place = (place + 1) % places_.size();
    places_[place].prefix = prefix;
    return ++places_[place].count;
  }

 private:
  struct Place {
    std::uint64_t prefix = 0;
    std::uint32_t count = 0;
  };
  std::uint64_t secret_;
  std::array<Place, 2 * NetworkTurns::kMostEntries> places_{};
};

}  // namespace

std::size_t NetworkTurns::oldest_of_most_crowded(std::span<const NetworkLevels> entries) const {
  DANCE_ASSERT(!entries.empty() && entries.size() <= kMostEntries, entries.size());
  NetworkLevels chosen;
  const auto is_within = [&](const NetworkLevels& entry, std::size_t levels) {
    return std::equal(entry.prefix.begin(),
                      entry.prefix.begin() + static_cast<std::ptrdiff_t>(levels),
                      chosen.prefix.begin());
  };
  for (std::size_t level = 0; level < NetworkLevels::kLevels; ++level) {
    PrefixCounts counts(secret_);
    std::uint32_t most = 0;
    for (const NetworkLevels& entry : entries) {
      if (!is_within(entry, level)) continue;
      const std::uint32_t count = counts.add(entry.prefix[level]);
      if (count <= most) continue;
      most = count;
      chosen.prefix[level] = entry.prefix[level];
    }
  }
  const auto oldest = std::find_if(entries.begin(), entries.end(), [&](const auto& entry) {
    return is_within(entry, NetworkLevels::kLevels);
  });
  return static_cast<std::size_t>(oldest - entries.begin());
}

}  // namespace dance

// A recorded line's capacity: the moments at which it could carry one packet more, as mahimahi's
// traces say it. Played from its begin and repeated at its end.
//
// Units/frames: milliseconds from the trace's begin; an opportunity carries up to 1,500 bytes,
//               headers of IP and UDP included.
// Ownership:    owns its opportunities.
// Threads:      none inside; read-only once made.
// Failure:      parse() names the line and what is wrong with it.
// Source:       the format of mahimahi's mm-link (Netravali et al., USENIX ATC 2015).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

class CapacityTrace {
 public:
  static constexpr std::size_t kOpportunity_bytes = 1500;
  // Of all opportunities of all rounds.
  using Number = std::uint64_t;

  // A whole number a line, none smaller than the one before; the last is the trace's length.
  static Result<CapacityTrace> parse(std::string_view text);

  Duration at(Number opportunity) const;
  // The first that is not before this time.
  Number first_from(Duration since_begin) const;

  Duration length() const { return Duration::ms(times_ms_.back()); }
  std::size_t size() const { return times_ms_.size(); }
  double mean_bps() const;

 private:
  std::vector<std::uint32_t> times_ms_;  // never empty, ascending, the last above 0
};

}  // namespace dance

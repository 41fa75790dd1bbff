// A recorded line: what delay, and whether a loss, a datagram met at each moment, as somebody
// measured it. Played from its begin and repeated at its end.
//
// Units/frames: times from the trace's begin; delays are one-way (half of a measured round trip).
// Ownership:    owns its points.
// Threads:      none inside; read-only once made.
// Failure:      parse() names the line and what is wrong with it.
#pragma once

#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

class DelayTrace {
 public:
  struct Point {
    Duration at;
    Duration delay;
    float loss = 0.0f;  // 0..1
  };

  // CSV with a header. Time: t_ms or t_s. Delay: owd_var_ms (one way, above the floor) or rtt_ms
  // (empty = lost). Optional: loss (0..1) and run (runs are played one after the other).
  static Result<DelayTrace> parse(std::string_view csv);

  const Point& at(Duration since_begin) const;
  Duration length() const { return length_; }
  std::size_t size() const { return points_.size(); }

 private:
  std::vector<Point> points_;  // never empty, times ascending
  Duration length_;
};

}  // namespace dance

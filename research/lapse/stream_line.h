// A line simulated for evaluations: poses with their capture times go in, what arrives comes out in
// the order of arrival, later ones before earlier ones where the line has it so. The same seed
// loses the same poses; for real traces and limits of rate there is testing/line/lossy_model.h.
//
// Units/frames: durations; loss in percent; capture times of whatever clock, arrivals of the same.
// Ownership:    plain values.
// Threads:      none.
// Failure:      none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/time.h"
#include "core/pose/pose.h"

namespace dance {

struct StreamLine {
  enum class Jitter {
    kExponential,  // often little, seldom much
    kGamma,        // the sum of two of the former, each half as long
    kNormal,       // a normal deviation with this mean of its size, never before the delay
  };
  // From `begin` on nothing arrives for a while.
  struct Stall {
    MonoTime begin;
    Duration length;
    bool loses = false;  // false: what was under way comes at its end, all at once
  };

  Duration delay = Duration::ms(100);
  Duration jitter;  // mean of what is added to the delay
  Jitter shape = Jitter::kGamma;
  double loss_percent = 0.0;
  std::vector<Stall> stalls;
  std::size_t every = 1;  // so many-th pose alone is sent: a sensor that is slower than the stage
  std::uint64_t seed = 1;
};

struct StreamArrival {
  MonoTime at;
  std::size_t index;  // which of the poses
};

std::vector<StreamArrival> arrivals_over(const StreamLine& line, std::span<const Pose> poses);

}  // namespace dance

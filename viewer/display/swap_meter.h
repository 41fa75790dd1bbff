// SwapMeter: from the capture of a pose to its picture on the screen, over the last seconds, and
// the share of each stage of the way.
//
// Units/frames: MonoTime of this process; poses of other clocks are not given to it.
// Ownership:    plain value; allocates nothing after construction.
// Threads:      none inside; the drawing thread owns it.
// Failure:      figures() is nullopt without a pose in the last seconds.
#pragma once

#include <optional>
#include <vector>

#include "viewer/display/display_path.h"

namespace dance {

struct SwapFigures {
  float p50_ms = 0.0f;
  float p99_ms = 0.0f;
  // Means of the stages: until it was heard here, until a picture took it, drawing, the swap.
  float coming_ms = 0.0f;
  float waiting_ms = 0.0f;
  float drawing_ms = 0.0f;
  float swapping_ms = 0.0f;
  std::size_t poses = 0;
};

class SwapMeter {
 public:
  static constexpr Duration kLast = Duration::s(5);
  SwapMeter() : samples_(kMost), totals_ms_(kMost) {}

  // A pose that this picture showed first.
  void add(MonoTime captured, MonoTime heard, const PictureTimes& times);
  std::optional<SwapFigures> figures(MonoTime now);

 private:
  static constexpr std::size_t kMost = 4096;
  struct Sample {
    MonoTime swapped;
    Duration coming, waiting, drawing, swapping;
  };
  std::vector<Sample> samples_;
  std::vector<float> totals_ms_;  // room to sort in
  std::size_t added_ = 0;
};

}  // namespace dance

// StereoSource: a source of pairs of pictures: one camera that delivers both views side by side, or
// two cameras whose pictures are paired by the time at which light fell on them. The newest pair
// wins.
//
// Units/frames: pixels of one camera; hertz; times of this machine's monotonic clock, which both
//               cameras' drivers stamp with.
// Ownership:    owns its sources; pictures are the sources' own (side by side: halves of one, not
//               copied) and good until the next call.
// Threads:      one owner; none inside.
// Failure:      making one names the sources and the cure. Later trouble is a FrameState; a picture
//               without its partner is dropped and counted; while the right one of two cameras is
//               unplugged the left one's pictures come alone, their right ones empty. trouble()
//               reports that, and capture times too far apart for a moving dancer.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "producers/camera/frame_source.h"

namespace dance {

struct StereoFrame {
  Frame left;
  Frame right;
};

class StereoSource {
 public:
  virtual ~StereoSource() = default;
  // Waits at most `timeout`.
  virtual FrameState next(Duration timeout, StereoFrame& out) = 0;
  // Of one camera.
  virtual const FrameFormat& format() const = 0;
  // Taken counts pairs, and pictures of the left camera that were given alone; the others are those
  // of both cameras together.
  virtual FrameCounters counters() const = 0;
  virtual const std::string& name() const = 0;
  // Pictures that came without the other camera's.
  virtual std::uint64_t unpaired() const { return 0; }
  // "" as long as all is well, else one line with the cure.
  virtual std::string trouble() const { return {}; }
};

// The left half is the left camera.
Result<std::unique_ptr<StereoSource>> make_side_by_side(std::unique_ptr<FrameSource> both);
Result<std::unique_ptr<StereoSource>> make_paired(std::unique_ptr<FrameSource> left,
                                                  std::unique_ptr<FrameSource> right);

// The cameras of one picture that holds both; nothing is copied.
struct StereoViews {
  cv::Mat left;
  cv::Mat right;
};
StereoViews split_side_by_side(const cv::Mat& both);

}  // namespace dance

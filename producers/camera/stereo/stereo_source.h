// StereoSource: where pairs of pictures come from: one camera that gives both eyes side by side, or
// two cameras whose pictures are paired by the time at which light fell on them. The newest pair
// wins.
//
// Units/frames: pixels of one eye; hertz; times of this machine's monotonic clock, which both
//               cameras' drivers stamp with.
// Ownership:    owns its sources; pictures are the sources' own (side by side: halves of one, not
//               copied) and good until the next call.
// Threads:      one owner; none inside.
// Failure:      making one names the sources and the cure. Later trouble is a FrameState; a picture
//               without its partner is dropped and counted; while the right one of two cameras is
//               gone the left one's pictures come alone, their right ones empty. trouble() says
//               that, and when the two are too far apart in time for somebody who moves.
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
  // Waits at most `patience`.
  virtual FrameState next(Duration patience, StereoFrame& out) = 0;
  // Of one eye.
  virtual const FrameFormat& format() const = 0;
  // Taken counts pairs, and pictures of the left eye that were given alone; the others are those of
  // both cameras together.
  virtual FrameCounters counters() const = 0;
  virtual const std::string& name() const = 0;
  // Pictures that came without the other eye's.
  virtual std::uint64_t unpaired() const { return 0; }
  // "" as long as all is well, else one line with the cure.
  virtual std::string trouble() const { return {}; }
};

// The left half is the left eye.
Result<std::unique_ptr<StereoSource>> make_side_by_side(std::unique_ptr<FrameSource> both);
Result<std::unique_ptr<StereoSource>> make_paired(std::unique_ptr<FrameSource> left,
                                                  std::unique_ptr<FrameSource> right);

// The eyes of one picture that holds both; nothing is copied.
struct EyeViews {
  cv::Mat left;
  cv::Mat right;
};
EyeViews split_side_by_side(const cv::Mat& both);

}  // namespace dance

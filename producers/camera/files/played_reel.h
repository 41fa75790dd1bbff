// PlayedReel: a PictureReel as a FrameSource: in real time, as from a camera, or as fast as it is
// read.
//
// Units/frames: in real time capture times follow the reel's own, from the first call on; else
//               picture i is of start + i/hz.
// Ownership:    owns the reel and its pictures; one that is still held is not overwritten.
// Threads:      one owner; none inside.
// Failure:      a picture that cannot be read is counted as damaged and left out, as is one time a
//               file that ends too early.
#pragma once

#include <memory>

#include "core/base/time.h"
#include "producers/camera/files/picture_reel.h"
#include "producers/camera/frame_source.h"
#include "producers/camera/picture_pool.h"

namespace dance {

struct PlayOptions {
  bool is_real_time =
      true;  // a reader slower than the reel gets the newest; the rest is counted as outrun
  bool loops = false;  // from the end to the beginning, for ever
  // Of frames without times of their own, and of all where it is not in real time; 0: the file's
  // own rate, 30 for still images.
  double hz = 0.0;
};

class PlayedReel : public FrameSource {
 public:
  PlayedReel(std::unique_ptr<PictureReel> reel, const PlayOptions& options);

  FrameState next(Duration timeout, Frame& out) override;
  const FrameFormat& format() const override { return format_; }
  const FrameCounters& counters() const override { return counters_; }
  const std::string& name() const override { return reel_->name(); }

 private:
  bool step();
  bool wait_until_due(Duration timeout);
  bool skip_what_is_late();

  std::unique_ptr<PictureReel> reel_;
  PlayOptions options_;
  FrameFormat format_;
  FrameCounters counters_;
  PicturePool pictures_;
  Duration period_;
  Duration round_;             // of all rounds of a loop before this one
  Duration last_time_;         // of the picture where it stands, since the first of the first round
  MonoTime fetched_;           // when work on the picture where it stands began
  MonoTime start_;             // not set: before the first call
  std::uint64_t stepped_ = 0;  // pictures so far
  bool stands_ = false;        // on a picture that was not given out
  bool is_over_ = false;
};

}  // namespace dance

// BvhConsumer: one guest's dance as a BVH file, at a steady frame rate whatever the rate and jitter
// of what was heard. The number of frames stands before them in a BVH file, so that the dance is
// kept in memory and written at the end.
//
// Units/frames: frames lie 1/hz apart on the capture clock; metres.
// Ownership:    keeps at most most_frames frames (about 100 MB); keeps its output.
// Threads:      none inside; one owner.
// Failure:      finish() says when no pose was heard or writing failed. What is left out is
//               counted: other guests, poses that are not newer, frames beyond the bound; silences
//               are cut out (formats/recording/steady_clip.h).
// Source:       as formats/bvh/bvh.h.
#pragma once

#include "consumers/output_file.h"
#include "consumers/pose_consumer.h"
#include "formats/recording/steady_clip.h"

namespace dance {

class BvhConsumer : public PoseConsumer {
 public:
  // The guest that is written; where it is not set, the first that is heard.
  BvhConsumer(std::shared_ptr<OutputFile> output, double hz, const GuestId& guest,
              std::size_t most_frames = SteadyClip::kMostFrames);

  void on_pose(const GuestId& guest, const Pose& pose, MonoTime now) override;
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) override;
  void on_hands(const GuestId& guest, const Hands& hands, MonoTime now) override;
  Result<void> finish() override;
  std::uint64_t left_out() const override { return of_others_ + clip_.counters().beyond_bound; }
  std::string summary() const override;

  const MotionClip& clip() const { return clip_.body(); }

 private:
  std::shared_ptr<OutputFile> output_;
  GuestId guest_;
  SteadyClip clip_;
  bool is_finished_ = false;
  std::uint64_t of_others_ = 0;
};

}  // namespace dance

// BvhConsumer: one guest's dance as a BVH file, at a steady frame rate whatever the rate and jitter
// of what was heard. The number of frames stands before them in a BVH file, so that the dance is
// kept in memory and written at the end.
//
// Units/frames: frames lie 1/hz apart on the capture clock; metres.
// Ownership:    keeps at most kMostFrames frames (about 100 MB); keeps its output.
// Threads:      none inside; one owner.
// Failure:      finish() says when no pose was heard or writing failed. What is left out is
//               counted: other guests, poses that are not newer, frames beyond the bound; a silence
//               above kLongestGap is cut out.
// Source:       as formats/bvh/bvh.h.
#pragma once

#include <optional>

#include "consumers/output_file.h"
#include "consumers/pose_consumer.h"
#include "core/pose/clip.h"

namespace dance {

class BvhConsumer : public PoseConsumer {
 public:
  static constexpr std::size_t kMostFrames = 60 * 3600;
  static constexpr Duration kLongestGap = Duration::s(2);

  // The guest that is written; where it is not set, the first that is heard.
  BvhConsumer(std::shared_ptr<OutputFile> output, double hz, const GuestId& guest,
              std::size_t most_frames = kMostFrames);

  void on_pose(const GuestId& guest, const Pose& pose, MonoTime now) override;
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) override;
  Result<void> finish() override;
  std::string summary() const override;

  const MotionClip& clip() const { return clip_; }

 private:
  void begin_grid(const Pose& pose);
  void add_frame(const Pose& pose);

  std::shared_ptr<OutputFile> output_;
  GuestId guest_;
  std::size_t most_frames_;
  MotionClip clip_;
  bool has_skeleton_ = false;
  bool is_finished_ = false;
  std::optional<Pose> previous_;
  MonoTime grid_start_;          // capture time of the grid's frame 0
  std::int64_t grid_index_ = 0;  // of the next frame
  std::uint64_t of_others_ = 0;
  std::uint64_t not_newer_ = 0;
  std::uint64_t gaps_ = 0;
  std::uint64_t beyond_bound_ = 0;
};

}  // namespace dance

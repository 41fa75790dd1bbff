// SteadyClip: one guest's dance on a steady grid of frames, whatever the rate and jitter of what
// was heard: for clip formats, whose frames have no times of their own.
//
// Units/frames: frames lie 1/hz apart on the capture clock, interpolated between two poses.
// Ownership:    keeps at most most_frames frames and as many hands (200 MB at the default).
// Threads:      none inside; one owner.
// Failure:      counted: poses and hands that are not newer, frames beyond the bound; a silence
//               above kLongestGap and a change of clock are cut out.
#pragma once

#include <optional>
#include <vector>

#include "core/pose/clip.h"

namespace dance {

class SteadyClip {
 public:
  static constexpr std::size_t kMostFrames = 60 * 3600;
  static constexpr Duration kLongestGap = Duration::s(2);

  struct Counters {
    std::uint64_t not_newer = 0;
    std::uint64_t gaps = 0;
    std::uint64_t beyond_bound = 0;
  };

  explicit SteadyClip(double hz, std::size_t most_frames = kMostFrames);

  // The last one holds for all frames.
  void set_skeleton(const Skeleton& skeleton);
  void add(const Pose& pose);
  void add(const Hands& hands);

  // The body's frames so far.
  const MotionClip& body() const { return clip_; }
  // With the hands, where any were heard: at each frame's time, interpolated between those around
  // it; before the first and after the last they are held.
  MotionClip with_hands() const;
  bool has_skeleton() const { return has_skeleton_; }
  const Counters& counters() const { return counters_; }

 private:
  void begin_grid(const Pose& pose);
  void add_frame(const Pose& pose);

  std::size_t most_frames_;
  MotionClip clip_;
  // Where a stretch without gaps begins: its first frame, and the hands heard since.
  struct Stretch {
    std::size_t first_frame;
    std::size_t first_hands;
  };
  std::vector<Stretch> stretches_;
  std::vector<Hands> hands_;
  bool has_skeleton_ = false;
  std::optional<Pose> previous_;
  MonoTime grid_start_;          // capture time of the grid's frame 0
  std::int64_t grid_index_ = 0;  // of the next frame
  Counters counters_;
};

}  // namespace dance

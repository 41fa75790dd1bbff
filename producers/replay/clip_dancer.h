// ClipDancer: plays a recorded dance: once or over and over, at any speed, anywhere on the floor.
// A loop cross-fades from the clip's end into its beginning and moves back to its first place, so
// that the dancer does not jump. Clips of equal length loop in step, so couples stay couples.
//
// Units/frames: metres and degrees on the floor plane of W; heading turns about +Y, 0 leaves the
//               clip as it is.
// Ownership:    shares the clip, which many dancers may play; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      an empty clip or a speed that is not above 0 is our bug.
#pragma once

#include <memory>

#include "core/pose/clip.h"
#include "producers/dancer.h"

namespace dance {

// Where the clip's origin stands on the floor, and how far it is turned.
struct FloorPlacement {
  double x_m = 0.0;
  double z_m = 0.0;
  double heading_deg = 0.0;
};

struct ClipDancerOptions {
  ClipEnd end = ClipEnd::kLoop;
  double speed = 1.0;
  FloorPlacement placement;
  Duration crossing = Duration::ms(300);   // cross-fade from the end into the beginning
  Duration walking_back = Duration::s(2);  // to where the clip began, before it ends
};

class ClipDancer final : public Dancer {
 public:
  explicit ClipDancer(std::shared_ptr<const MotionClip> clip,
                      const ClipDancerOptions& options = {});

  const Skeleton& skeleton() const override { return clip_->skeleton; }
  double natural_hz() const override { return clip_->frame_hz; }
  void dance_at(Duration t, Pose& out) override;
  bool hands_at(Duration t, Hands& out) override;
  bool is_over(Duration t) const override;

  // Length of one round of a loop: the clip without the part that is cross-faded.
  Duration round() const { return round_; }

 private:
  // The two moments of the clip that are shown at t, and how much of the second.
  struct Moment {
    Duration at;
    Duration ending;  // valid where crossed < 1
    float crossed = 1.0f;
  };
  Moment moment_of(Duration t) const;
  void sample(Duration at, Pose& out) const;
  float walked_back(Duration at) const;

  std::shared_ptr<const MotionClip> clip_;
  ClipDancerOptions options_;
  Duration last_;  // time of the clip's last frame
  Duration round_;
  Duration crossing_;
  Duration walking_back_;
  Eigen::Vector3f way_back_m_;  // from the end of a round to its beginning, on the floor
  Eigen::Quaternionf R_heading_;
};

}  // namespace dance

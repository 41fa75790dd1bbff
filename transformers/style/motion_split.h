// MotionSplit: takes a dance apart into a slowly changing mean pose, what comes again with each
// bar, and the rest. Each joint's turn against its mean, the tilt of the pelvis, and the sway of
// the hips over the feet; where the dancer faces and goes is no part of it.
//
// Units/frames: rotation vectors in each bone's mean frame, rad; sway in the dancer's frame (x to
//               the left, y up, z where the hips face), metres; positions in bars.
// Ownership:    fixed arrays; never allocates.
// Threads:      none inside; one owner.
// Failure:      before a bar and a half are seen, and where no bars are known, nothing is periodic.
// Source:       scaling the periodic part of motion: Unuma, Anjyo, Takeuchi, SIGGRAPH 1995.
#pragma once

#include <array>

#include "core/pose/kinematics.h"
#include "transformers/style/harmonic_fit.h"

namespace dance {

class MotionSplit {
 public:
  struct Part {
    std::array<Eigen::Vector3f, kBoneCount> turn;
    Eigen::Vector3f sway_m;
  };
  struct Parts {
    Eigen::Quaternionf R_heading;  // of the hips, about +Y
    Part deviation;                // from the mean: periodic + rest
    Part periodic;
    Part rest;
  };

  void forget();
  bool has_begun() const { return seen_s_ > 0.0; }
  // What a pose consists of, by what was learnt so far. `bars`: its position in the dance, NaN
  // where it is not known.
  void split(const Pose& pose, const BodyFrames& frames, double bars, Parts& out);
  // The same pose's parts are learnt from, dt_s after the one before.
  void learn(const Parts& parts, double bars, double dt_s);

  // How much of dt_s counts in a mean that follows as the mean pose does.
  double mean_share(double dt_s) const;
  // The mean with a deviation: the local rotation of a bone; for the hips their tilt against the
  // heading.
  Eigen::Quaternionf turned(std::size_t bone, const Eigen::Vector3f& deviation) const;

 private:
  float trust() const;

  std::array<Eigen::Quaternionf, kBoneCount> mean_turn_;
  Eigen::Vector3f mean_sway_m_ = Eigen::Vector3f::Zero();
  HarmonicFit fit_;
  double bars_ = 0.0, bars_per_s_ = 0.0, seen_bars_ = 0.0;
  double seen_s_ = 0.0;
  bool has_mean_ = false, has_bars_ = false;
};

}  // namespace dance

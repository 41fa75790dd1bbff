// EpipolarFit: where the second camera stands, and how much later its stamps are, so that rays of
// the same joint at the same moment meet: damped Gauss-Newton over turn, direction of the baseline
// and offset of the stamps, with Cauchy's weight against outliers. One iteration a call, so that no
// picture waits for it.
//
// Units/frames: residuals are Sampson distances in standard deviations of the rays.
// Ownership:    keeps its numbers (about 20 KB); never allocates.
// Threads:      none inside; one owner.
// Failure:      step() is false where too few moments are seen by both cameras, or the numbers are
//               not finite; the pose is then as it was.
// Source:       Hartley and Zisserman, Multiple View Geometry, 2004, chapter 11; the stamps as a
//               further unknown: Albl et al., On the two-view geometry of unsynchronized cameras,
//               CVPR 2017.
#pragma once

#include "producers/camera/multiview/key_moments.h"
#include "producers/camera/multiview/relative_pose.h"
#include "producers/camera/multiview/view_history.h"

namespace dance {

class EpipolarFit {
 public:
  // From here on. The turn is held near this one, as the networks' metres have it.
  void begin(const RelativePose& pose);
  bool step(const KeyMoments& moments, const ViewHistory& other, bool frees_time);

  const RelativePose& pose() const { return pose_; }
  int moments() const { return moments_; }
  // Of all residuals before the last step: their robust standard deviation, and a mean that
  // outliers hardly change, for comparing poses.
  double spread() const { return spread_; }
  double cost() const { return cost_; }
  // Standard deviations of what was found; errors of a network last, and are not independent.
  double turn_sd_rad() const { return sd_.head<3>().norm(); }
  double later_sd_s() const { return sd_[5]; }

 private:
  static constexpr std::size_t kMost = KeyMoments::kCapacity * kViewPointCount;

  RelativePose pose_;
  Eigen::Matrix3d given_R_BA_ = Eigen::Matrix3d::Identity();
  double spread_ = 0.0;
  double cost_ = 0.0;
  int moments_ = 0;
  RelativePose::Step sd_ = RelativePose::Step::Constant(1e3);
  std::array<float, kMost> sizes_;
};

// The robust standard deviation of one moment's residuals; negative where the other camera did not
// see enough of it.
double spread_of_moment(const RelativePose& pose, const ViewPoints& first,
                        const ViewHistory& other);

}  // namespace dance

#include "testing/xr/script/hand_skeleton.h"

#include <numbers>

namespace dance::test_xr {
namespace {

// The palm in the grip: fingers along -Y, thumbs along -Z, palms face each other.
Pose palm_in_grip(Hand hand) {
  const double side = hand == Hand::kLeft ? -1.0 : 1.0;
  Eigen::Matrix3d R;
  R.col(0) = Eigen::Vector3d(0.0, 0.0, side);
  R.col(1) = Eigen::Vector3d(side, 0.0, 0.0);
  R.col(2) = Eigen::Vector3d(0.0, 1.0, 0.0);
  return pose_of({side * 0.02, 0.0, 0.0}, Eigen::Quaterniond(R));
}

struct Finger {
  Eigen::Vector3d base_m;  // in the palm, of a right hand: +X to the little finger
  double yaw_rad;          // towards the thumb's side is positive
  std::array<double, 4> lengths_m;
  std::size_t count;  // the thumb has a bone less
};

// From the joint, along -Z, bent towards the palm: about +X, negative.
Pose next_joint(const Pose& joint, double length_m, double bend_rad) {
  Pose next = joint;
  next.translate(Eigen::Vector3d(0.0, 0.0, -length_m));
  next.rotate(Eigen::AngleAxisd(-bend_rad, Eigen::Vector3d::UnitX()));
  return next;
}

}  // namespace

HandSkeleton hand_skeleton(Hand hand, bool is_fist) {
  HandSkeleton skeleton;
  const double side = hand == Hand::kLeft ? -1.0 : 1.0;
  const Pose palm = palm_in_grip(hand);
  skeleton.T_GJ[0] = palm;
  skeleton.T_GJ[1] = palm * Eigen::Translation3d(0.0, 0.0, 0.065);  // the wrist
  skeleton.radius_m.fill(0.009f);
  skeleton.radius_m[0] = skeleton.radius_m[1] = 0.025f;
  const std::array<Finger, 5> fingers{{{{-0.02, -0.01, 0.04}, 0.7, {0.045, 0.03, 0.025, 0.0}, 4},
                                       {{-0.02, 0.0, 0.03}, 0.1, {0.065, 0.04, 0.025, 0.02}, 5},
                                       {{-0.003, 0.0, 0.03}, 0.0, {0.065, 0.045, 0.028, 0.02}, 5},
                                       {{0.012, 0.0, 0.03}, -0.08, {0.06, 0.04, 0.026, 0.02}, 5},
                                       {{0.026, 0.0, 0.03}, -0.17, {0.055, 0.032, 0.02, 0.02}, 5}}};
  std::size_t joint = 2;
  for (const Finger& finger : fingers) {
    Pose pose = palm;
    pose.translate(Eigen::Vector3d(side * finger.base_m.x(), finger.base_m.y(), finger.base_m.z()));
    pose.rotate(Eigen::AngleAxisd(side * finger.yaw_rad, Eigen::Vector3d::UnitY()));
    const double bend_rad = !is_fist ? 0.0 : finger.count == 4 ? 0.5 : 1.4;
    for (std::size_t i = 0; i < finger.count; ++i, ++joint) {
      skeleton.T_GJ[joint] = pose;
      if (i + 1 < finger.count)
        pose = next_joint(pose, finger.lengths_m[i], i + 2 < finger.count ? bend_rad : 0.0);
    }
  }
  return skeleton;
}

}  // namespace dance::test_xr

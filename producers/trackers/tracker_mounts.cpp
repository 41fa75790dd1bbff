#include "producers/trackers/tracker_mounts.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

// Of a body 1.72 m tall, from the bone's origin.
constexpr float kMountHeight_m = 1.72f;
constexpr float kEyesUp_m = 0.11f, kEyesForward_m = 0.09f;
constexpr float kPalmOut_m = 0.09f, kPalmDown_m = 0.02f, kPalmForward_m = 0.01f;

Quaternionf of_axes(const Vector3f& x, const Vector3f& y, const Vector3f& z) {
  Eigen::Matrix3f m;
  m << x, y, z;
  return Quaternionf(m);
}

}  // namespace

Mount nominal_mount(TrackedPoint point, float height_m) {
  const float scale = height_m / kMountHeight_m;
  const Vector3f x = Vector3f::UnitX(), y = Vector3f::UnitY(), z = Vector3f::UnitZ();
  switch (point) {
    case TrackedPoint::kHead:
      return {scale * Vector3f(0.0f, kEyesUp_m, kEyesForward_m), of_axes(-x, y, -z), true};
    case TrackedPoint::kLeftHand:
      return {scale * Vector3f(kPalmOut_m, -kPalmDown_m, kPalmForward_m), of_axes(-y, -x, -z),
              true};
    case TrackedPoint::kRightHand:
      return {scale * Vector3f(-kPalmOut_m, -kPalmDown_m, kPalmForward_m), of_axes(y, x, -z), true};
    default:
      return {};
  }
}

Place bone_place(const Mount& mount, const Place& device) {
  const Quaternionf R_WB = (device.R_W * mount.R_BT.conjugate()).normalized();
  return {device.p_W_m - R_WB * mount.p_BT_m, R_WB};
}

Place device_place(const Mount& mount, const Place& bone) {
  return {bone.p_W_m + bone.R_W * mount.p_BT_m, (bone.R_W * mount.R_BT).normalized()};
}

Mount mount_between(const Place& bone, const Place& device) {
  return {bone.R_W.conjugate() * (device.p_W_m - bone.p_W_m),
          (bone.R_W.conjugate() * device.R_W).normalized(), true};
}

}  // namespace dance

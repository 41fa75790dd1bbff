#include "research/trackers/worn_devices.h"

#include <cmath>

#include "core/motion/rotation_vector.h"
#include "core/pose/heading.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr double kPerDegree = 3.14159265358979 / 180.0;
constexpr double kFast_m = 0.00015, kSlow_m = 0.001;
constexpr double kFast_rad = 0.03 * kPerDegree, kSlow_rad = 0.2 * kPerDegree;
constexpr double kSlow_s = 0.3;

Vector3f normal_vector(Random& random, double sd) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return Eigen::Vector3d(sd * x, sd * y, sd * z).cast<float>();
}

}  // namespace

Vector3f WornDevices::vector(double sd) { return normal_vector(random_, sd); }

Mount WornDevices::strapped(TrackedPoint point) {
  const float side = random_.uniform() < 0.5 ? -1.0f : 1.0f;
  const float left = index_of(point) % 2 == 0 ? 1.0f : -1.0f;
  Mount mount;
  mount.is_known = true;
  mount.R_BT = Quaternionf(exp_rotation(vector(1.5))).normalized();
  switch (point) {
    case TrackedPoint::kHips:
      mount.p_BT_m = Vector3f(0.0f, 0.02f, 0.10f * side) + vector(0.025);
      break;
    case TrackedPoint::kLeftFoot:
    case TrackedPoint::kRightFoot:
      mount.p_BT_m = Vector3f(0.0f, 0.01f, 0.07f) + vector(0.012);
      break;
    case TrackedPoint::kLeftElbow:
    case TrackedPoint::kRightElbow: {
      const Bone lower =
          point == TrackedPoint::kLeftElbow ? Bone::kLeftLowerArm : Bone::kRightLowerArm;
      mount.p_BT_m = 0.75f * body_.offset(lower) + Vector3f(0.0f, 0.03f, -0.03f) + vector(0.015);
      break;
    }
    case TrackedPoint::kLeftKnee:
    case TrackedPoint::kRightKnee:
      mount.p_BT_m = 0.8f * body_.offset(Bone::kLeftLowerLeg) +
                     Vector3f(0.02f * left, 0.0f, 0.07f) + vector(0.015);
      break;
    default:
      mount.p_BT_m = Vector3f(0.0f, 0.05f, 0.12f) + vector(0.02);
  }
  return mount;
}

WornDevices::WornDevices(const Skeleton& body, std::uint32_t points, std::uint64_t seed)
    : body_(body), points_(points), random_(seed) {
  const float height_m = standing_height_m(body);
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    const auto point = static_cast<TrackedPoint>(i);
    Mount mount = nominal_mount(point, height_m);
    if (mount.is_known) {
      const bool is_head = point == TrackedPoint::kHead;
      mount.p_BT_m += vector(is_head ? 0.01 : 0.015);
      mount.R_BT =
          (mount.R_BT * exp_rotation(vector((is_head ? 3.0 : 6.0) * kPerDegree))).normalized();
    } else {
      mount = strapped(point);
    }
    mounts_[i] = mount;
    slow_m_[i].fill(vector(kSlow_m));
    slow_rad_[i].fill(vector(kSlow_rad));
  }
}

// Noise through two lags, so that it has no corners; its size is sd.
void WornDevices::wander(Wander& slow, double keep, double sd) {
  const auto k = static_cast<float>(keep);
  // Variance of white noise of size 1 after both lags: (1 - k)^4 (1 + k²) / (1 - k²)^3.
  const double left =
      std::pow(1.0 - keep, 4) * (1.0 + keep * keep) / std::pow(1.0 - keep * keep, 3);
  slow[0] = k * slow[0] + (1.0f - k) * vector(sd / std::sqrt(left));
  slow[1] = k * slow[1] + (1.0f - k) * slow[0];
}

TrackerFrame WornDevices::see(const Pose& pose, double hz) {
  BodyFrames frames;
  forward_kinematics(body_, pose, frames);
  TrackerFrame frame;
  frame.time = pose.capture_time;
  const double keep = std::exp(-1.0 / (hz * kSlow_s));
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    if ((points_ >> i & 1u) == 0) continue;
    wander(slow_m_[i], keep, kSlow_m);
    wander(slow_rad_[i], keep, kSlow_rad);
    const std::size_t b = index_of(kPointBones[i]);
    const Place seen = device_place(mounts_[i], {frames.p_WB_m[b], frames.R_WB[b]});
    frame.put(static_cast<TrackedPoint>(i), seen.p_W_m + slow_m_[i][1] + vector(kFast_m),
              (exp_rotation(slow_rad_[i][1] + vector(kFast_rad)) * seen.R_W).normalized());
  }
  return frame;
}

std::uint32_t point_set(int count) {
  const std::uint32_t three = 0b111;
  if (count < 4) return three;
  if (count < 6) return 0b1111;
  return count < 10 ? 0b111111u : 0b1111111111u;
}

Pose human_t_pose(const Skeleton& body, const Vector3f& hips_m, float heading_rad, Random& random) {
  Pose pose;
  const auto shaken = [&](double deg) {
    return Quaternionf(exp_rotation(normal_vector(random, deg * kPerDegree)));
  };
  for (Quaternionf& q : pose.R_PB) q = shaken(1.5);
  pose.R_PB[0] = about_up(heading_rad) * shaken(2.0);
  for (const Bone upper : {Bone::kLeftUpperArm, Bone::kRightUpperArm})
    pose.R_PB[index_of(upper)] = shaken(5.0);
  for (const Bone hand : {Bone::kLeftHand, Bone::kRightHand})
    pose.R_PB[index_of(hand)] = shaken(6.0);
  pose.R_PB[index_of(Bone::kHead)] = shaken(3.0);
  const auto bend = static_cast<float>((6.0 + 4.0 * random.uniform()) * kPerDegree);
  pose.R_PB[index_of(Bone::kLeftLowerArm)] = about_up(-bend);
  pose.R_PB[index_of(Bone::kRightLowerArm)] = about_up(bend);
  const auto out = static_cast<float>((6.0 + 3.0 * random.normal()) * kPerDegree);
  BodyFrames frames;
  pose.p_WH_m = hips_m;
  for (const float side : {1.0f, -1.0f}) {
    const Limb& leg = side > 0.0f ? kLeftLeg : kRightLeg;
    pose.R_PB[index_of(leg.lower)].setIdentity();
    forward_kinematics(body, pose, frames);
    const Quaternionf level = about_up(heading_rad + side * out);
    pose.R_PB[index_of(leg.end)] = frames.R_WB[index_of(leg.lower)].conjugate() * level;
  }
  forward_kinematics(body, pose, frames);
  const float sole = std::min(frames.tip(Tip::kLeftToes).y(), frames.tip(Tip::kRightToes).y());
  pose.p_WH_m.y() -= sole;
  normalize(pose);
  return pose;
}

}  // namespace dance

#include "core/motion/joint_limits.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/motion/rotation_vector.h"

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

constexpr float kRad = 0.017453293f;
// Furthest that a joint goes beyond a range.
constexpr float kGive_rad = 10.0f * kRad;
constexpr float kTurn_rad = 360.0f * kRad;
constexpr float kTellsApart_rad = 90.0f * kRad;
// A joint turned by less than the narrowest range, 5°, is skipped: sin²(2.4°).
constexpr float kSurelyWithin = 0.00175f;

// Degrees of rotation about x, y, z of the parent, left side and middle; one of the axes is the
// bone's own.
struct Range {
  Bone bone;
  int twist_axis;
  float low[3];
  float high[3];
};

constexpr float kFree = 1000.0f;
constexpr Range kRanges[]{
    {Bone::kSpine, 1, {-75, -60, -60}, {100, 60, 60}},
    {Bone::kChest, 1, {-45, -45, -45}, {60, 45, 45}},
    {Bone::kUpperChest, 1, {-40, -40, -40}, {50, 40, 40}},
    {Bone::kNeck, 1, {-65, -85, -60}, {65, 85, 60}},
    {Bone::kHead, 1, {-90, -85, -70}, {75, 85, 70}},
    {Bone::kLeftShoulder, 0, {-45, -45, -45}, {45, 45, 45}},
    // An arm of the T-pose reaches forward about -y and up about +z.
    {Bone::kLeftUpperArm, 0, {-140, -155, -130}, {155, 115, 125}},
    // Captures differ in how they distribute the roll of the arm, so only backward bending is
    // limited.
    {Bone::kLeftLowerArm, 0, {-110, -165, -120}, {100, 8, 160}},
    // The forearm's twist is in the hand.
    {Bone::kLeftHand, 0, {-kFree, -100, -95}, {kFree, 100, 95}},
    // A leg swings forward about -x, outward about +z.
    {Bone::kLeftUpperLeg, 1, {-150, -80, -55}, {65, 80, 110}},
    {Bone::kLeftLowerLeg, 1, {-5, -65, -30}, {165, 80, 30}},
    {Bone::kLeftFoot, 1, {-80, -85, -75}, {90, 85, 75}},
    {Bone::kLeftToes, 1, {-75, -45, -35}, {75, 45, 35}},
};

struct Limit {
  Vector3f low = Vector3f::Constant(-kFree);
  Vector3f high = Vector3f::Constant(kFree);
  int twist_axis = 0;
  bool is_set = false;
};

std::size_t right_of(Bone left) {
  const std::size_t i = index_of(left);
  return i < index_of(Bone::kLeftShoulder) ? i : i + 4;
}

std::array<Limit, kBoneCount> make_limits() {
  std::array<Limit, kBoneCount> limits;
  for (const Range& range : kRanges) {
    Limit& left = limits[index_of(range.bone)];
    left = {kRad * Vector3f(range.low[0], range.low[1], range.low[2]),
            kRad * Vector3f(range.high[0], range.high[1], range.high[2]), range.twist_axis, true};
    const std::size_t other = right_of(range.bone);
    if (other == index_of(range.bone)) continue;
    // Seen in the mirror, x turns as before, y and z the other way.
    limits[other] = left;
    for (int axis = 1; axis < 3; ++axis) {
      limits[other].low[axis] = -left.high[axis];
      limits[other].high[axis] = -left.low[axis];
    }
  }
  return limits;
}

const std::array<Limit, kBoneCount>& limits_of_joints() {
  static const std::array<Limit, kBoneCount> limits = make_limits();
  return limits;
}

// Linear within, saturating beyond, with a smooth transition. Returns whether it was beyond.
bool saturate(float& angle, float low, float high) {
  if (angle > high)
    angle = high - kGive_rad * std::expm1((high - angle) / kGive_rad);
  else if (angle < low)
    angle = low + kGive_rad * std::expm1((angle - low) / kGive_rad);
  else
    return false;
  return true;
}

float beyond(float angle, float low, float high) {
  return std::max({0.0f, low - angle, angle - high});
}

bool limit_joint(const Limit& limit, Quaternionf& q) {
  const int axis = limit.twist_axis;
  const float w = std::abs(q.w());
  const float along = q.w() < 0.0f ? -q.vec()[axis] : q.vec()[axis];
  // q = swing · twist
  const float size = std::sqrt(w * w + along * along);
  Quaternionf twist = Quaternionf::Identity();
  if (size > 1e-6f) {
    twist.w() = w / size;
    twist.vec()[axis] = along / size;
  }
  float twist_rad = 2.0f * std::atan2(along, w);
  Vector3f swing = rotation_vector(q * twist.conjugate());
  // Beyond half a turn the angles change their sign: a joint bent too far is not one bent the other
  // way.
  const float turn = swing.norm();
  if (turn > kTellsApart_rad) {
    const Vector3f other = swing * ((turn - kTurn_rad) / turn);
    float here_rad = 0.0f, there_rad = 0.0f;
    for (int i = 0; i < 3; ++i) {
      if (i == axis) continue;
      here_rad += beyond(swing[i], limit.low[i], limit.high[i]);
      there_rad += beyond(other[i], limit.low[i], limit.high[i]);
    }
    if (there_rad < here_rad) swing = other;
  }
  bool is_beyond = false;
  for (int i = 0; i < 3; ++i) {
    float& angle = i == axis ? twist_rad : swing[i];
    is_beyond = saturate(angle, limit.low[i], limit.high[i]) || is_beyond;
  }
  if (!is_beyond) return false;
  swing[axis] = 0.0f;
  q = (exp_rotation(swing) * exp_rotation(twist_rad * Vector3f::Unit(axis))).normalized();
  return true;
}

}  // namespace

int limit_joints(Pose& pose) {
  const std::array<Limit, kBoneCount>& limits = limits_of_joints();
  int beyond = 0;
  for (std::size_t b = 1; b < kBoneCount; ++b) {
    if (!limits[b].is_set || pose.R_PB[b].vec().squaredNorm() < kSurelyWithin) continue;
    beyond += limit_joint(limits[b], pose.R_PB[b]) ? 1 : 0;
  }
  return beyond;
}

}  // namespace dance

#include "viewer/figure/limb_fit.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kShortest_m = 1e-4f;
// What a nearly straight limb bends about is mostly its hinge; sines of the bend.
constexpr float kHingeCounts = 0.15f;
constexpr float kMostOverstretch = 0.3f;
constexpr float kTurnsAlong = 0.5f;
// The side of an arm that is straight as danced turns as it likes, which does not count.
constexpr float kMostDanced_rad = 0.25f;

// The angle between sides a and b of a triangle whose third side is c.
float corner_rad(float a, float b, float c) {
  return std::acos(std::clamp((a * a + b * b - c * c) / (2.0f * a * b), -1.0f, 1.0f));
}

// The shortest turn between two unit vectors.
Quaternionf short_turn(const Vector3f& from, const Vector3f& to) {
  const float w = 1.0f + from.dot(to);
  if (w < 1e-6f) {  // opposite
    const Vector3f axis = from.unitOrthogonal();
    return Quaternionf(0.0f, axis.x(), axis.y(), axis.z());
  }
  const Vector3f axis = from.cross(to);
  return Quaternionf(w, axis.x(), axis.y(), axis.z()).normalized();
}

// A bone's direction, and the hinge as near to the normal as it is at right angles to it.
Eigen::Matrix3f frame_of(const Vector3f& bone, const Vector3f& normal) {
  Eigen::Matrix3f frame;
  frame.col(0) = bone.normalized();
  frame.col(2) = (normal - frame.col(0) * frame.col(0).dot(normal)).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

// `side` as far as it may have turned since the last picture.
Vector3f limited(const Vector3f& side, const Vector3f& danced, const Vector3f& along,
                 LimbSide& past) {
  Vector3f shown = side;
  const Vector3f before = past.shown_W - along * along.dot(past.shown_W);
  if (past.is_known && before.norm() > 1e-3f) {
    const Vector3f from = before.normalized();
    const float angle = std::atan2(along.dot(from.cross(side)), from.dot(side));
    const float most =
        past.most_turn_rad +
        std::min(kMostDanced_rad, std::acos(std::clamp(danced.dot(past.danced_W), -1.0f, 1.0f)));
    if (std::abs(angle) > most) shown = Eigen::AngleAxisf(std::copysign(most, angle), along) * from;
  }
  past.shown_W = shown;
  past.danced_W = danced;
  past.is_known = true;
  return shown;
}

}  // namespace

Vector3f hinge_of(const Limb& limb) {
  if (limb.upper == Bone::kLeftUpperArm) return -Vector3f::UnitY();
  if (limb.upper == Bone::kRightUpperArm) return Vector3f::UnitY();
  return Vector3f::UnitX();
}

float fit_limb(const Limb& limb, const Vector3f& target_W_m, const Vector3f& hinge_W, float stretch,
               BodyFrames& frames, LimbSide* past) {
  const std::size_t upper = index_of(limb.upper), lower = index_of(limb.lower),
                    end = index_of(limb.end);
  const Vector3f root = frames.p_WB_m[upper];
  const Vector3f first = stretch * (frames.p_WB_m[lower] - root);
  const Vector3f second = stretch * (frames.p_WB_m[end] - frames.p_WB_m[lower]);
  const float a = first.norm(), b = second.norm();
  const Vector3f to_target = target_W_m - root;
  const float wanted = to_target.norm();
  const Vector3f reach_was = first + second;
  const float was = reach_was.norm();
  if (a < kShortest_m || b < kShortest_m || wanted < kShortest_m || was < kShortest_m)
    return (target_W_m - frames.p_WB_m[end]).norm();

  const float most = std::max(kStraightLimb * (a + b), std::min(was, a + b));
  const float least =
      std::min({most, was, std::max(1.05f * std::abs(a - b), kFoldedLimb * (a + b))});
  const float distance = std::clamp(wanted, least, most);
  // The normal of the plane the limb lies in; where it is nearly straight the hinge's.
  const Vector3f cross = first.cross(second) / (a * b);
  Vector3f hinge = hinge_W - reach_was * (reach_was.dot(hinge_W) / (was * was));
  // Overstretched ones bend back through straight, not by a turn about themselves.
  const float size = hinge.norm();
  Vector3f normal = cross;
  if (size > 1e-3f) {
    hinge /= size;
    const float over = std::clamp(-hinge.dot(cross), 0.0f, kMostOverstretch);
    normal += (kHingeCounts + over) * hinge;
  }
  normal -= reach_was * (reach_was.dot(normal) / (was * was));
  if (normal.squaredNorm() < 1e-8f) normal = reach_was.unitOrthogonal();

  // The side on which the middle joint lies: mostly as it is in W (elbows that point down go on
  // to), and as far as the line to the end is turned along with it, as one of the two always has a
  // direction.
  const Vector3f line = reach_was / was, along = to_target / wanted;
  normal.normalize();
  const Vector3f side_was = line.cross(normal);
  Vector3f side = side_was + kTurnsAlong * (short_turn(line, along) * side_was);
  side -= along * along.dot(side);
  if (side.squaredNorm() < 1e-8f) side = along.unitOrthogonal();
  side.normalize();
  if (past != nullptr) side = limited(side, side_was, along, *past);
  const Vector3f normal_now = side.cross(along);
  const float corner = corner_rad(a, distance, b);
  const Vector3f first_now = a * (std::cos(corner) * along + std::sin(corner) * side);
  const Vector3f second_now = distance * along - first_now;
  const auto turn = [&](const Vector3f& from, const Vector3f& to) {
    return Quaternionf(frame_of(to, normal_now) * frame_of(from, normal).transpose());
  };
  frames.R_WB[upper] = (turn(first, first_now) * frames.R_WB[upper]).normalized();
  frames.R_WB[lower] = (turn(second, second_now) * frames.R_WB[lower]).normalized();
  frames.p_WB_m[lower] = root + first_now;
  frames.p_WB_m[end] = frames.p_WB_m[lower] + second_now;
  return (target_W_m - frames.p_WB_m[end]).norm();
}

}  // namespace dance

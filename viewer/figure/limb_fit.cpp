#include "viewer/figure/limb_fit.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kShortest_m = 1e-4f;
// What a nearly straight limb bends about is mostly its hinge; sines of the bend.
constexpr float kHingeCounts = 0.05f;
constexpr float kMostOverstretch = 0.3f;

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

}  // namespace

Vector3f hinge_of(const Limb& limb) {
  if (limb.upper == Bone::kLeftUpperArm) return -Vector3f::UnitY();
  if (limb.upper == Bone::kRightUpperArm) return Vector3f::UnitY();
  return Vector3f::UnitX();
}

float fit_limb(const Limb& limb, const Vector3f& target_W_m, const Vector3f& hinge_W, float stretch,
               BodyFrames& frames) {
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

  // Along the line to where the end was, the first bone leaves it by the corner at the root.
  const Vector3f line = reach_was / was;
  normal.normalize();
  const float corner = corner_rad(a, distance, b);
  const Vector3f bent_first = a * (std::cos(corner) * line - std::sin(corner) * normal.cross(line));
  const Vector3f bent_second = distance * line - bent_first;
  const Quaternionf bend_first = short_turn(first / a, bent_first / a);
  const Quaternionf bend_second = short_turn(second / b, bent_second.normalized());
  const Quaternionf swing = short_turn(line, to_target / wanted);
  frames.R_WB[upper] = (swing * bend_first * frames.R_WB[upper]).normalized();
  frames.R_WB[lower] = (swing * bend_second * frames.R_WB[lower]).normalized();
  frames.p_WB_m[lower] = root + swing * bent_first;
  frames.p_WB_m[end] = frames.p_WB_m[lower] + swing * bent_second;
  return (target_W_m - frames.p_WB_m[end]).norm();
}

}  // namespace dance

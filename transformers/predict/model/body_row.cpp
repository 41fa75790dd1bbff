#include "transformers/predict/model/body_row.h"

#include "core/motion/rotation_vector.h"
#include "core/pose/heading.h"

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

constexpr float kTurn = 6.28318531f;

// The same rotation, as near to `before` as full turns bring it.
Vector3f counted_on(const Vector3f& vector, const Vector3f& before) {
  const float angle = vector.norm();
  if (angle < 1.0f) return vector;
  const Vector3f other = vector * ((angle - kTurn) / angle);
  return (other - before).squaredNorm() < (vector - before).squaredNorm() ? other : vector;
}

}  // namespace

BodySpace::BodySpace(const BoneRotations& centres) : centres_(centres) {}

BodyRow BodySpace::row_of(const Pose& pose, const BodyRow* before) const {
  BodyRow row;
  const Quaternionf& hips = pose.R_PB[0];
  float heading = 2.0f * std::atan2(hips.y(), hips.w());
  // Hips upside down have no heading: it stays.
  const bool has_heading = hips.y() * hips.y() + hips.w() * hips.w() > 1e-6f;
  if (before) {
    if (!has_heading) heading = before->heading();
    heading += kTurn * std::round((before->heading() - heading) / kTurn);
  }
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const Vector3f was = before ? Vector3f((*before)(b, 0), (*before)(b, 1), (*before)(b, 2))
                                : Vector3f(Vector3f::Zero());
    Vector3f vector = was;
    if (!before || (pose.presence >> b & 1u) != 0) {
      const Quaternionf local =
          b == 0 ? about_up(heading).conjugate() * hips : centres_[b].conjugate() * pose.R_PB[b];
      vector = counted_on(rotation_vector(local), was);
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
      row(b, axis) = vector[static_cast<Eigen::Index>(axis)];
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    row(kPlaceGroup, axis) = pose.p_WH_m[static_cast<Eigen::Index>(axis)];
  row(kHeadingGroup, 0) = heading;
  return row;
}

void BodySpace::pose_of(const BodyRow& row, Pose& pose) const {
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const Quaternionf local = exp_rotation(Vector3f(row(b, 0), row(b, 1), row(b, 2)));
    pose.R_PB[b] = ((b == 0 ? about_up(row.heading()) : centres_[b]) * local).normalized();
  }
  pose.p_WH_m = {row(kPlaceGroup, 0), row(kPlaceGroup, 1), row(kPlaceGroup, 2)};
}

}  // namespace dance

#include "viewer/avatar/mannequin_shape.h"

#include <cmath>

namespace dance {
namespace {

Eigen::Vector3f rounded(const Eigen::Vector3f& offset_m) {
  return (offset_m / kShapeStep_m).array().round() * kShapeStep_m;
}

bool is_near(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return (a - b).cwiseAbs().maxCoeff() <= kShapeStep_m;
}

void append(std::string& key, const Eigen::Vector3f& offset_m) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto steps = static_cast<std::int16_t>(std::lround(offset_m[axis] / kShapeStep_m));
    key += static_cast<char>(steps & 0xff);
    key += static_cast<char>(steps >> 8);
  }
}

}  // namespace

MannequinShape::MannequinShape(const Skeleton& skeleton, bool has_fingers)
    : skeleton_(skeleton), has_fingers_(has_fingers) {
  for (Eigen::Vector3f& offset_m : skeleton_.offset_m) offset_m = rounded(offset_m);
  for (Eigen::Vector3f& tip_m : skeleton_.tip_m) tip_m = rounded(tip_m);
}

bool MannequinShape::fits(const Skeleton& skeleton, bool has_fingers) const {
  if (has_fingers && !has_fingers_) return false;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    if (!is_near(skeleton.offset_m[b], skeleton_.offset_m[b])) return false;
  for (std::size_t t = 0; t < kTipCount; ++t)
    if (!is_near(skeleton.tip_m[t], skeleton_.tip_m[t])) return false;
  return true;
}

void MannequinShape::append_to(std::string& key) const {
  for (const Eigen::Vector3f& offset_m : skeleton_.offset_m) append(key, offset_m);
  for (const Eigen::Vector3f& tip_m : skeleton_.tip_m) append(key, tip_m);
  key += has_fingers_ ? 'f' : 'm';
}

}  // namespace dance

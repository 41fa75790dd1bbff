#include "formats/bvh/bvh_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/assert.h"

namespace dance {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Vector3d BvhFigure::end_of(const Bvh& bvh, std::size_t joint) const {
  if (const auto& end = bvh.joints[joint].end_site) return p_FJ[joint] + R_FJ[joint] * *end;
  std::size_t below = 0;  // children and theirs; one alone is an only child without its own
  std::size_t last = joint;
  for (std::size_t j = joint + 1; j < bvh.joints.size(); ++j) {
    const int parent = bvh.joints[j].parent;
    if (parent != static_cast<int>(joint) && (below == 0 || parent != static_cast<int>(last)))
      continue;
    ++below;
    last = j;
  }
  return below == 1 ? p_FJ[last] : p_FJ[joint];
}

Vector3d BvhFigure::far_end_of(const Bvh& bvh, std::size_t joint) const {
  Vector3d furthest = p_FJ[joint];
  std::vector<bool> is_below(bvh.joints.size(), false);
  is_below[joint] = true;
  const auto consider = [&](const Vector3d& place) {
    if ((place - p_FJ[joint]).norm() > (furthest - p_FJ[joint]).norm()) furthest = place;
  };
  for (std::size_t j = joint; j < bvh.joints.size(); ++j) {
    const int parent = bvh.joints[j].parent;
    if (j != joint) is_below[j] = parent >= 0 && is_below[static_cast<std::size_t>(parent)];
    if (!is_below[j]) continue;
    consider(p_FJ[j]);
    if (const auto& end = bvh.joints[j].end_site) consider(p_FJ[j] + R_FJ[j] * *end);
  }
  return furthest;
}

// A joint's position channels either repeat its OFFSET (then they replace it) or hold what is to
// be added to it, zero at rest.
BvhPositionDistance position_distance(const Bvh& bvh, const std::vector<bool>& counts) {
  BvhPositionDistance distance;
  const std::size_t step = sample_step(bvh);
  for (std::size_t f = 0; f < bvh.frame_count; f += step) {
    const float* values = bvh.frame(f);
    for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
      const BvhJoint& joint = bvh.joints[j];
      if (joint.parent < 0 || (!counts.empty() && !counts[j])) continue;
      for (std::size_t c = 0; c < joint.channel_count; ++c) {
        if (!is_position(joint.channels[c])) continue;
        const auto value = static_cast<double>(values[joint.first_channel + c]);
        distance.from_offset += std::abs(value - joint.offset[axis_of(joint.channels[c])]);
        distance.from_zero += std::abs(value);
      }
    }
  }
  return distance;
}

BvhMotion::BvhMotion(const Bvh& bvh)
    : bvh_(bvh),
      adds_positions_(!bvh.positions_replace_offsets && position_distance(bvh).looks_added()) {}

Vector3d BvhMotion::local_position(std::size_t index, const float* values) const {
  const BvhJoint& joint = bvh_.joints[index];
  Vector3d position = joint.offset;
  if (!values) return position;
  for (std::size_t c = 0; c < joint.channel_count; ++c) {
    if (!is_position(joint.channels[c])) continue;
    const int axis = axis_of(joint.channels[c]);
    const auto value = static_cast<double>(values[joint.first_channel + c]);
    const bool added = adds_positions_ && joint.parent >= 0;
    position[axis] = added ? joint.offset[axis] + value : value;
  }
  return position;
}

Quaterniond BvhMotion::local_rotation(std::size_t index, const float* values) const {
  constexpr double kRadPerDeg = std::numbers::pi / 180.0;
  const BvhJoint& joint = bvh_.joints[index];
  Quaterniond rotation = Quaterniond::Identity();
  for (std::size_t c = 0; c < joint.channel_count; ++c) {
    if (!is_rotation(joint.channels[c])) continue;
    const double angle_rad = static_cast<double>(values[joint.first_channel + c]) * kRadPerDeg;
    const Vector3d axis = Vector3d::Unit(axis_of(joint.channels[c]));
    rotation = rotation * Quaterniond(Eigen::AngleAxisd(angle_rad, axis));
  }
  return rotation;
}

void BvhMotion::figure_at(std::size_t frame, BvhFigure& figure) const {
  DANCE_ASSERT(frame < bvh_.frame_count, frame, bvh_.frame_count);
  const float* values = bvh_.frame(frame);
  figure.p_FJ.resize(bvh_.joints.size());
  figure.R_FJ.resize(bvh_.joints.size());
  for (std::size_t j = 0; j < bvh_.joints.size(); ++j) {
    const Vector3d position = local_position(j, values);
    const Quaterniond rotation = local_rotation(j, values);
    if (bvh_.joints[j].parent < 0) {
      figure.p_FJ[j] = position;
      figure.R_FJ[j] = rotation;
      continue;
    }
    const auto parent = static_cast<std::size_t>(bvh_.joints[j].parent);
    figure.p_FJ[j] = figure.p_FJ[parent] + figure.R_FJ[parent] * position;
    figure.R_FJ[j] = (figure.R_FJ[parent] * rotation).normalized();
  }
}

void BvhMotion::zero_figure(BvhFigure& figure) const {
  const float* values = bvh_.frame_count > 0 ? bvh_.frame(0) : nullptr;
  figure.p_FJ.resize(bvh_.joints.size());
  figure.R_FJ.assign(bvh_.joints.size(), Quaterniond::Identity());
  for (std::size_t j = 0; j < bvh_.joints.size(); ++j) {
    const int parent = bvh_.joints[j].parent;
    const Vector3d position = local_position(j, values);
    figure.p_FJ[j] =
        parent < 0 ? position : Vector3d(figure.p_FJ[static_cast<std::size_t>(parent)] + position);
  }
}

}  // namespace dance

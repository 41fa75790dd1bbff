#include "formats/bvh/rig/rig_positions.h"

#include <algorithm>
#include <cmath>

#include "formats/bvh/rig/rig_stance.h"
#include "formats/bvh/rig/rig_tree.h"

namespace dance {
namespace {

using Eigen::Vector3d;

// Floors nearer to each other than this share of a leg decide nothing.
constexpr double kSameFloor = 0.02;
constexpr double kFootPercentile = 0.10;

bool has_positions(const BvhJoint& joint) {
  for (std::size_t c = 0; c < joint.channel_count; ++c)
    if (is_position(joint.channels[c])) return true;
  return false;
}

// Distance of the lower foot's usual height from the floor of the file.
double distance_from_floor(const BvhMotion& motion, const Rig& rig) {
  const Bvh& bvh = motion.bvh();
  const Vector3d mean = mean_up(motion, rig);
  int axis = 0;
  mean.cwiseAbs().maxCoeff(&axis);
  const Vector3d up = Vector3d::Unit(axis) * (mean[axis] < 0.0 ? -1.0 : 1.0);
  const std::size_t step = sample_step(bvh);
  std::vector<double> lows;
  BvhFigure figure;
  for (std::size_t f = 0; f < bvh.frame_count; f += step) {
    motion.figure_at(f, figure);
    const auto low = [&](Bone shin) {
      const auto joint = static_cast<std::size_t>(rig.joint(shin));
      return up.dot(figure.far_end_of(bvh, joint));
    };
    lows.push_back(std::min(low(Bone::kLeftLowerLeg), low(Bone::kRightLowerLeg)));
  }
  if (lows.empty()) return 0.0;
  const auto rank =
      static_cast<std::ptrdiff_t>(kFootPercentile * static_cast<double>(lows.size() - 1));
  std::nth_element(lows.begin(), lows.begin() + rank, lows.end());
  return std::abs(lows[static_cast<std::size_t>(rank)]);
}

}  // namespace

BvhPositions positions_of(const Bvh& bvh, const Rig& rig) {
  if (bvh.positions_replace_offsets) return BvhPositions::kReplaceOffsets;
  const RigTree tree(bvh);
  const auto read_as = [](bool is_added) {
    return is_added ? BvhPositions::kAddToOffsets : BvhPositions::kReplaceOffsets;
  };
  // Joints that carry the whole dancer go anywhere; bones of the body keep their lengths.
  const int hips = rig.joint(Bone::kHips);
  std::vector<bool> is_body(bvh.joints.size(), false);
  bool carries = false;
  for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
    if (bvh.joints[j].parent < 0 || !has_positions(bvh.joints[j])) continue;
    const bool is_above_hips = tree.is_above(static_cast<int>(j), hips);
    is_body[j] = !is_above_hips;
    carries = carries || is_above_hips;
  }
  const double leg = (tree.rest(rig.joint(Bone::kLeftLowerLeg)) - tree.rest(hips)).norm();
  const BvhPositionDistance body = position_distance(bvh, is_body);
  const auto frames =
      static_cast<double>(std::clamp<std::size_t>(bvh.frame_count, 1, kSampledFrames));
  if (std::abs(body.from_offset - body.from_zero) > kSameFloor * leg * frames)
    return read_as(body.looks_added());
  if (!carries) return read_as(position_distance(bvh).looks_added());
  const double replaced = distance_from_floor(BvhMotion(bvh, BvhPositions::kReplaceOffsets), rig);
  const double added = distance_from_floor(BvhMotion(bvh, BvhPositions::kAddToOffsets), rig);
  if (std::abs(replaced - added) > kSameFloor * leg) return read_as(added < replaced);
  return read_as(position_distance(bvh).looks_added());
}

}  // namespace dance

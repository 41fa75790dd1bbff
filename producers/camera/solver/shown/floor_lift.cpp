#include "producers/camera/solver/shown/floor_lift.h"

#include <algorithm>

namespace dance {

using Eigen::Vector3f;

namespace {

constexpr Duration kSink = Duration::ms(120);
// Of the floor that is not known, upwards.
constexpr float kRises_m_s = 0.6f;

}  // namespace

float lowest_of_foot_m(const BodyShape& shape, const BodyFrames& frames, std::size_t side) {
  const Bone foot = side == 0 ? Bone::kLeftFoot : Bone::kRightFoot;
  const auto height = [&](const Eigen::Vector3d& in_foot) {
    return (frames.position(foot) + frames.R_WB[index_of(foot)] * in_foot.cast<float>()).y();
  };
  return std::min({height(shape.point_m[point_of(side == 0 ? Sole::kLeftHeel : Sole::kRightHeel)]),
                   height(shape.point_m[point_of(side == 0 ? Sole::kLeftBall : Sole::kRightBall)]),
                   frames.tip(side == 0 ? Tip::kLeftToes : Tip::kRightToes).y()});
}

void FloorLift::apply(const BodyShape& shape, bool has_floor, double seconds, Pose& pose) {
  BodyFrames frames;
  forward_kinematics(shape.skeleton, pose, frames);
  const float needed =
      -std::min(lowest_of_foot_m(shape, frames, 0), lowest_of_foot_m(shape, frames, 1));
  const auto step = static_cast<float>(std::clamp(seconds, 0.0, 0.5));
  // Joints count too: of a body that lies, the feet may be raised.
  float lowest = -needed;
  for (const Eigen::Vector3f& p : frames.p_WB_m) lowest = std::min(lowest, p.y());
  for (const Eigen::Vector3f& p : frames.p_WT_m) lowest = std::min(lowest, p.y());
  floor_m_ = is_first_ ? lowest : std::min(lowest, floor_m_ + kRises_m_s * step);
  // Up at once, down as a spring: to where the body is seen, or to the floor as long as nothing
  // says where that is.
  const float rest = has_floor ? 0.0f : -floor_m_;
  lift_.offset.y() -= rest;
  lift_.advance(Spring::y_of_half_life(kSink), step);
  lift_.offset.y() += rest;
  if (is_first_ || lift_.offset.y() < needed) {
    lift_.offset.y() = is_first_ ? std::max(rest, needed) : needed;
    lift_.velocity.setZero();
  }
  is_first_ = false;
  pose.p_WH_m.y() += lift_.offset.y();
}

}  // namespace dance

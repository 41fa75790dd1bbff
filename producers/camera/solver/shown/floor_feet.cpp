#include "producers/camera/solver/shown/floor_feet.h"

#include <algorithm>
#include <cmath>

#include "core/motion/leg_reach.h"

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

constexpr Duration kRelease = Duration::ms(60);
constexpr double kComesDown_s = 0.15;
constexpr float kComesDownOver_s = 0.05f;
constexpr float kMostSlide_m_s = 0.015f;
// A leg that stands is hardly ever quite straight; how far hips come down for it.
constexpr float kReach = 0.995f, kMostDrop = 0.06f;
constexpr float kNothing_m = 1e-5f;

}  // namespace

void FloorFeet::apply(const BodyShape& shape, const SoleContacts& contacts, bool has_floor,
                      bool holds, double seconds, Pose& pose) {
  const auto step = static_cast<float>(std::clamp(seconds, 1e-3, 0.5));
  BodyFrames frames;
  forward_kinematics(shape.skeleton, pose, frames);
  const BodyFrames like = frames;
  std::array<Vector3f, 2> offsets;
  for (std::size_t s = 0; s < 2; ++s) {
    Foot& foot = feet_[s];
    const Limb& leg = s == 0 ? kLeftLeg : kRightLeg;
    const std::size_t ball = point_of(s == 0 ? Sole::kLeftBall : Sole::kRightBall);
    const std::size_t heel = point_of(s == 0 ? Sole::kLeftHeel : Sole::kRightHeel);
    const Vector3f ankle = frames.position(leg.end);
    const Quaternionf R_WFoot = frames.R_WB[index_of(leg.end)];
    const auto at = [&](const Eigen::Vector3d& in_foot) {
      return Vector3f(ankle + R_WFoot * in_foot.cast<float>());
    };
    // The toes' joint is what stays: the sole below it goes with every small roll of the foot.
    const Vector3f joint = shape.skeleton.offset(Bone::kLeftToes);
    const Vector3f ball_W = at(joint.cast<double>());
    const float joint_height = joint.y() - static_cast<float>(shape.point_m[ball].y());
    const SoleTouch& touch = contacts.touch(ball - kLandmarkCount);
    const bool stands = has_floor && holds && touch.stands;
    if (stands) {
      Vector3f held = foot.is_held ? foot.held_W_m : Vector3f(ball_W + foot.shift.offset);
      held.y() = joint_height;
      // Towards the contact's place: at once while the foot comes down, later imperceptibly slowly.
      Vector3f off = touch.held_W_m.cast<float>() - held;
      off.y() = 0.0f;
      const float way = off.norm();
      if (touch.stands_for_s < kComesDown_s)
        held += off * (1.0f - std::exp(-step / kComesDownOver_s));
      else if (way > 1e-6f)
        held += off / way * std::min(way, step * kMostSlide_m_s);
      const Vector3f before = foot.shift.offset;
      // Down to the floor in a few pictures, not at once.
      Vector3f wanted = held - ball_W;
      if (!foot.is_held) wanted.y() = before.y() + 0.5f * (wanted.y() - before.y());
      foot.shift.velocity = (wanted - before) / step;
      const float speed = foot.shift.velocity.norm();
      if (speed > 1.0f) foot.shift.velocity /= speed;
      foot.shift.offset = wanted;
      foot.held_W_m = held;
      foot.is_held = true;
    } else {
      foot.is_held = false;
      foot.shift.advance(Spring::y_of_half_life(kRelease), step);
      if (foot.shift.is_at_rest()) foot.shift = Spring();
    }
    Vector3f offset = foot.shift.offset;
    if (has_floor) {
      const Eigen::Vector3d tip =
          (shape.skeleton.offset(Bone::kLeftToes) + shape.skeleton.tip(Tip::kLeftToes))
              .cast<double>();
      const float lowest =
          std::min({at(shape.point_m[ball]).y(), at(shape.point_m[heel]).y(), at(tip).y()}) +
          offset.y();
      offset.y() += std::max(0.0f, -lowest);
    }
    offsets[s] = offset;
  }
  lower_hips(shape, like, offsets, step, pose);
  forward_kinematics(shape.skeleton, pose, frames);
  for (std::size_t s = 0; s < 2; ++s) {
    const Limb& leg = s == 0 ? kLeftLeg : kRightLeg;
    if (drop_.offset.y() < kNothing_m && offsets[s].cwiseAbs().maxCoeff() < kNothing_m) continue;
    reach_ankle(shape.skeleton, leg, like, like.position(leg.end) + offsets[s],
                like.R_WB[index_of(leg.end)], pose, frames);
  }
}

void FloorFeet::lower_hips(const BodyShape& shape, const BodyFrames& like,
                           const std::array<Vector3f, 2>& offsets, float step, Pose& pose) {
  float needed = 0.0f;
  for (std::size_t s = 0; s < 2; ++s) {
    if (!feet_[s].is_held) continue;
    const Limb& leg = s == 0 ? kLeftLeg : kRightLeg;
    const float reach =
        kReach * (shape.skeleton.offset(leg.lower).norm() + shape.skeleton.offset(leg.end).norm());
    const Vector3f way = like.position(leg.upper) - (like.position(leg.end) + offsets[s]);
    const float aside2 = way.x() * way.x() + way.z() * way.z();
    needed = std::max(needed, way.y() - std::sqrt(std::max(0.0f, reach * reach - aside2)));
  }
  needed = std::min(needed, kMostDrop);
  // Down when it has to be, up again as a spring.
  drop_.advance(Spring::y_of_half_life(kRelease), step);
  if (needed > drop_.offset.y()) {
    drop_.offset.y() = needed;
    drop_.velocity.setZero();
  }
  pose.p_WH_m.y() -= drop_.offset.y();
}

}  // namespace dance

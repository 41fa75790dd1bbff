#include "producers/camera/solver/floor_feet.h"

#include <algorithm>
#include <cmath>

#include "transformers/leg_reach.h"

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

constexpr Duration kRelease = Duration::ms(60);
constexpr double kComesDown_s = 0.15;
constexpr float kComesDownOver_s = 0.05f;
constexpr float kMostSlide_m_s = 0.015f;
constexpr float kNothing_m = 1e-5f;

}  // namespace

void FloorFeet::apply(const BodyShape& shape, const SoleContacts& contacts, bool has_floor,
                      double seconds, Pose& pose) {
  const auto step = static_cast<float>(std::clamp(seconds, 1e-3, 0.5));
  BodyFrames frames;
  forward_kinematics(shape.skeleton, pose, frames);
  const BodyFrames like = frames;
  for (std::size_t s = 0; s < 2; ++s) {
    Foot& foot = feet_[s];
    const Limb& leg = s == 0 ? kLeftLeg : kRightLeg;
    const std::size_t ball = point_of(s == 0 ? Sole::kLeftBall : Sole::kRightBall);
    const std::size_t heel = point_of(s == 0 ? Sole::kLeftHeel : Sole::kRightHeel);
    const Landmark toe = s == 0 ? Landmark::kLeftFootIndex : Landmark::kRightFootIndex;
    const Vector3f ankle = frames.position(leg.end);
    const Quaternionf R_WFoot = frames.R_WB[index_of(leg.end)];
    const auto at = [&](const Eigen::Vector3d& in_foot) {
      return Vector3f(ankle + R_WFoot * in_foot.cast<float>());
    };
    const Vector3f ball_W = at(shape.point_m[ball]);
    const SoleTouch& touch = contacts.touch(ball - kLandmarkCount);
    const bool stands = has_floor && touch.stands;
    if (stands) {
      Vector3f held = foot.is_held ? foot.held_W_m : Vector3f(ball_W + foot.shift.offset);
      held.y() = 0.0f;
      // Towards where the foot is known to stand: at once while it comes down, later so that nobody sees it.
      const Vector3f off = touch.held_W_m.cast<float>() - held;
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
      Eigen::Vector3d tip =
          shape.point_m[point_of(toe)] + shape.skeleton.offset(Bone::kLeftToes).cast<double>();
      tip.y() = shape.point_m[ball].y();
      const float lowest =
          std::min({ball_W.y(), at(shape.point_m[heel]).y(), at(tip).y()}) + offset.y();
      offset.y() += std::max(0.0f, -lowest);
    }
    if (offset.cwiseAbs().maxCoeff() < kNothing_m) continue;
    reach_ankle(shape.skeleton, leg, like, ankle + offset, R_WFoot, pose, frames);
  }
}

}  // namespace dance

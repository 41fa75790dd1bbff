// One salsa dancer without arms: feet that stand where the score says and roll over ball and heel,
// hips that go to the standing leg, a spine that follows them a moment later.
//
// Units/frames: beats of the music; places in W.
// Ownership:    plain values, no allocation.
// Threads:      none inside; pure functions.
// Failure:      none.
#pragma once

#include "core/pose/kinematics.h"
#include "core/pose/pose.h"
#include "producers/salsa/salsa_score.h"

namespace dance {

// Where a foot is: the ball (the toes' joint) and how the foot is turned about it.
struct SalsaFoot {
  Eigen::Vector3f p_WBall_m = Eigen::Vector3f::Zero();
  double yaw_rad = 0.0;
  double heel_rad = 0.0;    // heel up about the ball
  bool is_planted = false;  // the ball rests on the floor
};

struct SalsaBody {
  Pose pose;
  BodyFrames frames;
  SalsaHold hold;
  double sway = 0.0;
  std::array<SalsaFoot, 2> feet;  // left, right
};

// Beats from a foot's leaving the floor to its landing: between two steps, and after a pause.
constexpr double kSalsaSwing_beats = 0.70;
constexpr double kSalsaSlowSwing_beats = 0.90;

SalsaFoot salsa_foot(const SalsaCounts& counts, const Skeleton& skeleton, bool is_left,
                     double beats);

// The couple's hold at a moment of the music, from either dancer's counts.
SalsaHold salsa_hold(const SalsaCounts& counts, double beats);

// Everything but arms and head, which need the partner. `delay_beats` is what a twentieth of a
// second is in beats, the time by which the upper body is behind the hips.
void pose_salsa_body(const SalsaCounts& counts, const Skeleton& skeleton, double beats,
                     double delay_beats, double energy, SalsaBody& body);

}  // namespace dance

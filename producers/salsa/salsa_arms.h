// Arms, hands and heads of a salsa couple: where the two hold each other, worked out from both
// bodies, so that each dancer's own half of it meets the other's.
//
// Units/frames: metres in W.
// Ownership:    plain values, no allocation.
// Threads:      none inside; pure functions.
// Failure:      none.
#pragma once

#include "producers/salsa/salsa_body.h"

namespace dance {

// The palm, where hands meet: this share of the way from the wrist to the finger tips.
constexpr float kPalmShare = 0.5f;

// Where a hand goes and how it lies there.
struct HandGoal {
  Eigen::Vector3f p_WPalm_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f fingers_W = Eigen::Vector3f::UnitZ();  // direction, about
  Eigen::Vector3f back_W = Eigen::Vector3f::UnitY();     // of the hand, about
  Eigen::Vector3f elbow_W = Eigen::Vector3f::UnitY();    // direction in which the elbow points
};

struct ArmGoals {
  HandGoal left;
  HandGoal right;
};

// Both dancers' arms from both bodies, and from the hold of the couple.
struct CoupleGoals {
  ArmGoals lead;
  ArmGoals follow;
};
CoupleGoals couple_goals(const Skeleton& lead_skeleton, const SalsaBody& lead,
                         const Skeleton& follow_skeleton, const SalsaBody& follow, double beats);

// Puts the arms where they belong and has the head look at the partner; then all frames are
// current.
void pose_arms(const Skeleton& skeleton, const ArmGoals& goals, SalsaBody& body);
void pose_head(const Skeleton& skeleton, const Eigen::Vector3f& partner_W_m, SalsaBody& body);

// Relaxed fingers, closing around the partner's where hands are joined.
void pose_fingers(const SalsaHold& hold, bool is_lead, double beats, Hands& hands);

}  // namespace dance

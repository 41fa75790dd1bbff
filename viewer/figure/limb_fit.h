// Brings the end of an arm or a leg to a place: elbow or knee stay on the side on which they are as
// danced, and both bones keep their roll about themselves seen from the plane the limb lies in.
//
// Units/frames: metres in W.
// Ownership:    changes the limb's two bones and the place of its end in `frames`; no allocation.
// Threads:      none inside.
// Failure:      what is out of reach is pointed at; the distance left is returned.
#pragma once

#include "core/pose/kinematics.h"

namespace dance {

// A limb is not straightened further than this share of its length, unless it was: the angle of a
// straight joint changes ever faster.
constexpr float kStraightLimb = 0.998f;
// Nor folded further than to this share, unless it was: nearer to its root the direction of its end
// changes ever faster.
constexpr float kFoldedLimb = 0.27f;

// On which side the middle joint was in the last picture: it turns to another no faster than
// most_turn_rad a picture, besides what the dance turns it.
struct LimbSide {
  Eigen::Vector3f shown_W = Eigen::Vector3f::Zero();
  Eigen::Vector3f danced_W = Eigen::Vector3f::Zero();
  float most_turn_rad = 0.0f;
  bool is_known = false;
};

// `hinge_W`: the axis about which the limb bends where it is straight. `stretch` lengthens both
// bones.
float fit_limb(const Limb& limb, const Eigen::Vector3f& target_W_m, const Eigen::Vector3f& hinge_W,
               float stretch, BodyFrames& frames, LimbSide* past = nullptr);

// The hinge as it is in T-pose: elbows bend forward, knees backward.
Eigen::Vector3f hinge_of(const Limb& limb);

}  // namespace dance

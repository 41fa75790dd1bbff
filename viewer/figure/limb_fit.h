// Brings the end of an arm or a leg to a place: the elbow or knee bends about the axis it bends
// about already, then the limb as a whole turns the shortest way. So it keeps its side and its
// twist as danced, and a small change of the place is a small change of the limb.
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

// `hinge_W`: the axis about which the limb bends where it is straight. `stretch` lengthens both
// bones.
float fit_limb(const Limb& limb, const Eigen::Vector3f& target_W_m, const Eigen::Vector3f& hinge_W,
               float stretch, BodyFrames& frames);

// The hinge as it is in T-pose: elbows bend forward, knees backward.
Eigen::Vector3f hinge_of(const Limb& limb);

}  // namespace dance

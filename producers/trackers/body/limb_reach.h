// What brings limbs and spine to where they shall be, on frames in W.
//
// Units/frames: W, metres.
// Ownership:    plain values, no allocation.
// Threads:      none inside.
// Failure:      what is out of reach is come as near to as possible; the rest is returned.
#pragma once

#include "core/pose/kinematics.h"
#include "producers/trackers/tracker_mounts.h"

namespace dance {

// The rotation R, turned the short way so that what pointed along `from` points along `to`.
Eigen::Quaternionf turned_along(const Eigen::Vector3f& from, const Eigen::Vector3f& to,
                                const Eigen::Quaternionf& R);

// Turns spine, chest, upper chest and neck, each as little as possible, until the head comes to
// p_WHead_m; where they cannot, the hips move. Their rotations are in frames.R_WB, the hips' place
// too; positions up to the head are set.
// What the spine is too long or too short the hips take at once: bending for that is sudden where
// the spine is nearly straight, and lengths are known to a centimetre or two only.
void bend_spine(const Skeleton& skeleton, const Eigen::Vector3f& p_WHead_m, BodyFrames& frames);

// Turns the shoulder, as far as shoulders go, until the arm's reach comes to the target.
void raise_shoulder(const Skeleton& skeleton, const Limb& arm, const Eigen::Vector3f& target_W_m,
                    BodyFrames& frames);

// Brings the limb's end to the target with its middle joint towards `middle_W_m`. The rotations in
// `frames` are those of the guess, whose twist is kept; `bend_W` is where the joint bends to when
// the limb is straight. Returns the distance left.
float reach_limb(const Skeleton& skeleton, const Limb& limb, const Eigen::Vector3f& target_W_m,
                 const Eigen::Vector3f& middle_W_m, const Eigen::Vector3f& bend_W,
                 BodyFrames& frames);

// Raises the heel of a foot that stands on its ball until the leg of this length reaches its ankle.
void raise_heel(const Eigen::Vector3f& hip_W_m, float leg_m, const Eigen::Vector3f& o_ball,
                Place& foot);

// Lifts the foot out of the floor.
void keep_above_floor(const Skeleton& skeleton, bool left, Place& foot);

// The toes' rotation in W: as the foot, bent where they would go into the floor.
Eigen::Quaternionf toes_on_floor(const Skeleton& skeleton, bool left, const Place& foot);

}  // namespace dance

// The posture that the network's metres tell directly, from the directions of bones: where a fit
// begins when nothing is expected, and what it is held against when it seems to be caught in a
// wrong one.
//
// Units/frames: directions in C come into W through the camera's placement.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      limbs of which too little is seen are at ease.
#pragma once

#include "producers/camera/solver/body_model.h"
#include "producers/camera/solver/body_shape.h"
#include "producers/camera/solver/body_state.h"
#include "producers/camera/solver/observation.h"

namespace dance {

// All but the hips' place.
BodyState first_posture(const Observation& seen, const BodyShape& shape,
                        const Eigen::Matrix3d& R_WC);

// Takes those limbs from `told` that `state` has in quite another direction than is seen: a fit
// that begins there would be caught.
void take_far_limbs(const Observation& seen, const Eigen::Matrix3d& R_WC, const BodyModel& placed,
                    const BodyState& told, BodyState& state);

}  // namespace dance

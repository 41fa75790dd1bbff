// An initial posture directly from the directions of bones in the network's world points: the start
// of a fit without a prediction, and the alternative when a fit seems to be in a wrong minimum.
//
// Units/frames: directions in C come into W through the camera's placement.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      limbs of which too little is visible are in the rest posture.
#pragma once

#include "producers/camera/solver/body_model.h"
#include "producers/camera/solver/body_shape.h"
#include "producers/camera/solver/body_state.h"
#include "producers/camera/solver/observation.h"

namespace dance {

// All but the hips' place.
BodyState first_posture(const Observation& seen, const BodyShape& shape,
                        const Eigen::Matrix3d& R_WC);

// Takes from `direct` those limbs whose direction in `state` is far from the observed one: a fit
// from there would end in a wrong minimum.
void take_far_limbs(const Observation& seen, const Eigen::Matrix3d& R_WC, const BodyModel& placed,
                    const BodyState& direct, BodyState& state);

}  // namespace dance

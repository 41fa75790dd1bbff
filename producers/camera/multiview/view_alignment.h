// The first estimate of where a second camera stands beside the first: both networks give the same
// body in metres, each in its camera's axes, so that the directions of its bones tell the turn
// between the cameras, and the places of its hips the way.
//
// Units/frames: as relative_pose.h.
// Ownership:    plain functions.
// Threads:      any; pure; nothing allocates.
// Failure:      false where too few moments were seen by both.
// Source:       Kabsch: A solution for the best rotation to relate two sets of vectors, Acta
//               Crystallographica, 1976.
#pragma once

#include "producers/camera/multiview/key_moments.h"
#include "producers/camera/multiview/relative_pose.h"
#include "producers/camera/multiview/view_history.h"

namespace dance {

// `later_s` of `out` is taken as it is.
bool align_views(const KeyMoments& moments, const ViewHistory& other, RelativePose& out);

}  // namespace dance

// The nodes of an avatar, parents first, and where each is at rest.
//
// Units/frames: metres; T_MN from a node's axes to the model's.
// Ownership:    fills the model of the source.
// Threads:      none inside.
// Failure:      a node that is too far away, or whose scale is too large, is an error.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "formats/avatar/read/avatar_source.h"

namespace dance {

Result<void> read_nodes(AvatarSource& source);

// Of each node of the model.
std::vector<Eigen::Affine3d> rest_transforms(const AvatarModel& model);

bool is_above(const AvatarModel& model, int ancestor, int node);  // true of a node and itself

// Turns the figure, by its roots, so that it faces +Z with its head up: a half turn for VRM 0.x,
// nothing for most others. What was turned is noted where it is no half turn.
Result<void> turn_to_front(AvatarSource& source);

}  // namespace dance

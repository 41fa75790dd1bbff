// The rotation that turns one direction into another the shortest way. Eigen's FromTwoVectors()
// does the same through a singular value decomposition, which costs compile time in every file that
// uses it.
//
// Units/frames: both directions, of any length, in one frame.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none: opposite directions turn by half about some perpendicular axis, a zero vector
//               gives identity.
#pragma once

#include <Eigen/Geometry>

namespace dance {

Eigen::Quaterniond shortest_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace dance

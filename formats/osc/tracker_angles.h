// TrackerAngles: a rotation as the three angles that VRChat takes, chosen so that they run on
// without jumps from one pose to the next.
//
// Units/frames: degrees about x, y and z of Unity's axes, for the rotation R = Ry(y) Rx(x) Rz(z):
//               applied z first, then x, then y. They grow with a dancer who spins, up to twenty
//               turns, and come back then by as many, which is the same rotation.
// Ownership:    remembers the last angles; never allocates.
// Threads:      none inside; one owner.
// Failure:      none; where x is a right angle, z stays as it was and y takes the whole turn.
// Source:       VRChat's OSC trackers; Unity's Quaternion.Euler.
#pragma once

#include <Eigen/Geometry>

namespace dance {

class TrackerAngles {
 public:
  // R in Unity's axes.
  Eigen::Vector3f follow(const Eigen::Quaternionf& R);

 private:
  Eigen::Vector3f last_deg_ = Eigen::Vector3f::Zero();
};

// The rotation of such angles, in Unity's axes.
Eigen::Quaternionf rotation_of_angles(const Eigen::Vector3f& angles_deg);

}  // namespace dance

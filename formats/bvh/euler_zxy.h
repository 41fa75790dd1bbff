// A rotation as the three angles of BVH's channels Zrotation Xrotation Yrotation.
//
// Units/frames: degrees; R = Rz(z) · Rx(x) · Ry(y).
// Threads:      none inside.
// Failure:      none; at the pole, where only z ± y is known, y is 0.
#pragma once

#include <Eigen/Geometry>
#include <array>

namespace dance {

std::array<double, 3> euler_zxy_deg(const Eigen::Quaterniond& rotation);

}  // namespace dance

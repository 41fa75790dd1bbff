// The dark spots on the floor under a figure: under each foot, where it nearly touches, and a wide
// faint one under the hips.
//
// Units/frames: metres in W.
// Ownership:    appends to the caller's list.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "viewer/figure/figure_poser.h"

namespace dance {

// As the vertex shader takes it, one instance each.
struct ContactSpot {
  Eigen::Vector3f centre_W_m;
  float half_length_m;
  Eigen::Vector3f along_W;  // unit, on the floor
  float half_width_m;
  float darkness;  // 0..1
};
static_assert(sizeof(ContactSpot) == 36);

void append_contact_spots(const PosedFigure& figure, std::vector<ContactSpot>& spots);

}  // namespace dance

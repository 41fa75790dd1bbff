// The pictures of an avatar, drawn by formulas: a pattern of cloth that repeats without an edge,
// and an eye with its iris.
//
// Units/frames: colours are linear RGB; pictures 8-bit sRGB.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include "formats/avatar/avatar_model.h"
#include "formats/avatar/make/avatar_design.h"

namespace dance {

AvatarPicture cloth_picture(ClothPattern pattern, const Eigen::Vector3f& ground,
                            const Eigen::Vector3f& drawn);
// The front half of an eyeball, seen from the front.
AvatarPicture eye_picture(const Eigen::Vector3f& iris);

}  // namespace dance

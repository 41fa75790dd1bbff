// Makes an avatar of the project's own design: a dancer's body in clothes, with a face that has
// expressions, hands with fingers, hair and cloth that swing.
//
// Units/frames: as AvatarModel.
// Ownership:    plain values.
// Threads:      none inside; takes about a second.
// Failure:      none; the model is sound. The same design makes the same model.
#pragma once

#include "formats/avatar/avatar_model.h"
#include "formats/avatar/make/avatar_design.h"

namespace dance {

constexpr const char* kAvatarLicence = "CC0 1.0";
constexpr const char* kAvatarLicenceUrl = "https://creativecommons.org/publicdomain/zero/1.0/";

AvatarModel make_avatar(const AvatarDesign& design);

}  // namespace dance

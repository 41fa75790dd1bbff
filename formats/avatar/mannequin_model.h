// The figure of a dancer without an avatar: the project's own body in the dancer's proportions and
// clothes (formats/body), as an AvatarModel, so that one renderer and one retargeting serve both.
//
// Units/frames: as formats/avatar/avatar_model.h; node b is bone b, kBoneCount + f finger bone f,
//               all unrotated in T-pose.
// Ownership:    plain values.
// Threads:      none inside; takes about 0.15 s, so that a display makes it beside its drawing.
// Failure:      none.
#pragma once

#include "core/pose/skeleton.h"
#include "formats/avatar/avatar_model.h"
#include "formats/body/guest_look.h"

namespace dance {

AvatarModel mannequin_model(const Skeleton& skeleton, const GuestLook& look, bool has_fingers);

}  // namespace dance

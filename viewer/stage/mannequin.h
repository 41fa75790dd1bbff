// The body that stands for a guest: torso, head with a face, arms, hands, legs and shoes round the
// canonical bones, in the guest's own proportions and colours.
//
// Units/frames: metres in W. Sizes are those of a body 1.72 m tall, scaled to the guest's height.
// Ownership:    appends to the caller's lists.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include "formats/body/guest_look.h"
#include "viewer/scene/scene.h"
#include "viewer/stage/body_part.h"

namespace dance {

enum class BodyDetail { kPlain, kFine };  // kPlain: mittens, unless the guest sends its fingers

void append_mannequin(const SceneGuest& guest, BodyDetail detail, BodyParts& parts);

}  // namespace dance

// The head of a mannequin: skin, hair, and a face whose eyes turn and whose lids and mouth move.
//
// Units/frames: metres, T-pose, as formats/avatar/avatar_model.h.
#pragma once

#include "core/pose/skeleton.h"
#include "formats/avatar/make/model_builder.h"
#include "formats/body/guest_look.h"

namespace dance {

// `skin` and `hair` are materials of the builder.
void add_mannequin_head(const Skeleton& skeleton, const GuestLook& look, int skin, int hair,
                        ModelBuilder& builder);

}  // namespace dance

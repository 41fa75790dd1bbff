// An avatar's hair: a cap with locks in layers of the head, and strands that swing on chains of
// nodes.
//
// Units/frames: as FaceSurface.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include "formats/avatar/make/face/face_surface.h"
#include "formats/avatar/make/model_builder.h"

namespace dance {

// What stays in place on the head.
FigureLayer hair_layer(const FaceSurface& face, Hair style);

// Ponytail and locks beside the face: adds their nodes and springs, gives their surface.
Sheet swinging_hair(const FaceSurface& face, Hair style, ModelBuilder& builder,
                    const std::vector<std::uint32_t>& colliders);

}  // namespace dance

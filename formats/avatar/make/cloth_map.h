// Lays the picture of a shirt's cloth round trunk and sleeves, with a seam below each sleeve and
// where a sleeve begins, as shirts have them.
//
// Units/frames: as Sheet.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include "formats/avatar/make/sheet.h"
#include "formats/body/figure_builder.h"

namespace dance {

// Sets uv; vertices at a seam become two.
void map_shirt(Sheet& sheet, const TposePlaces& places);

}  // namespace dance

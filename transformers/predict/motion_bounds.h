// Bounds on how far and how fast a body moves, for displacements (ways) and slopes: what is beyond
// comes from a sensor that lost a limb for a frame, and would outweigh seconds of dance where
// squares are summed.
//
// Units/frames: rows and ways as transformers/predict/body_row.h; slopes per row, 60 a second.
// Ownership:    changes what it is given.
// Threads:      any.
// Failure:      bound_motion() is false, and the way none at all, where the numbers are none.
#pragma once

#include <cstddef>

#include "transformers/predict/body_row.h"

namespace dance {

// A way to kHorizonFrames[horizon] from now.
bool bound_motion(std::size_t horizon, BodyRow& way);
void bound_slope(BodyRow& slope);

}  // namespace dance

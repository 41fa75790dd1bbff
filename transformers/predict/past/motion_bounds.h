// Bounds of human motion on displacements and slopes: larger ones are outliers of the sensor, which
// would outweigh seconds of dance in least squares.
//
// Units/frames: rows and displacements as transformers/predict/model/body_row.h; slopes per row,
//               60 a second.
// Ownership:    changes its argument.
// Threads:      any.
// Failure:      bound_motion() is false, and the displacement 0, where numbers are not finite.
#pragma once

#include <cstddef>

#include "transformers/predict/model/body_row.h"

namespace dance {

// A displacement from now to kHorizonFrames[horizon].
bool bound_motion(std::size_t horizon, BodyRow& way);
void bound_slope(BodyRow& slope);

}  // namespace dance

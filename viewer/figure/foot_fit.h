// Puts an avatar's feet where the dancer's stand: the ball of the foot at the same place of the
// floor, the lowest point of the sole as high as the dancer's, toes bent where the heel is up. The
// legs are solved by two-bone IK; the hips come down where a standing leg would not reach.
//
// A sole within a few centimetres of the floor is brought nearer to it, as recorded feet hover: at
// 2 cm by 19 mm, at 6 cm by nothing. It depends on the pose alone, not on the past, so that a
// picture is the same however it was come to.
//
// Units/frames: metres in W; the floor is y = 0.
// Ownership:    changes the figure's frames; no allocation.
// Threads:      none inside.
// Failure:      none: a foot out of reach stays where the leg ends.
#pragma once

#include "viewer/figure/figure_fit.h"

namespace dance {

void fit_feet(FigureFit& fit);

// The height of the lowest of a foot's points.
float lowest_m(const FootPoints& points, const BodyFrames& frames, std::size_t side);

}  // namespace dance

// A thin seam round neck and arms where cloth ends on skin, which hides that the two surfaces cut
// each other there.
//
// Units/frames: as Sheet.
// Ownership:    refers to the layers.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include "formats/avatar/make/sheet.h"
#include "formats/body/skin_weights.h"

namespace dance {

struct Opening {
  const FigureLayer& cloth;
  const FigureLayer& skin;
  // Of the limb that comes out: inside both surfaces at the beginning, inside the skin at the end.
  Eigen::Vector3f begin_m;
  Eigen::Vector3f end_m;
};

Sheet edging(const Opening& opening, float radius_m, const SkinWeighting& weighting);

}  // namespace dance

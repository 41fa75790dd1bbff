// The fingers of an average hand, scaled to the dancer's own: where each finger bone begins in
// T-pose. Of a dancer's hand only its length is known.
//
// Units/frames: metres, axes of W in T-pose (palms down, thumbs forward); each from its parent
//               finger bone, or from the wrist.
// Threads:      none inside.
// Failure:      none.
// Source:       lengths of phalanges: Buryanov and Kotiuk, Proportions of Hand Segments,
//               International Journal of Morphology 28(3), 2010.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/pose/skeleton.h"

namespace dance {

using FingerOffsets = std::array<Eigen::Vector3f, kFingerBoneCount>;

FingerOffsets average_hand(const Skeleton& skeleton);

}  // namespace dance

// Makes an actor of Studio's out of one of our dancers: every joint's place and global rotation.
//
// Units/frames: pose, hands and skeleton in W; the actor in Studio's space.
// Ownership:    plain values; never allocates.
// Threads:      none inside.
// Failure:      none.
// Source:       our three bones of the spine become Studio's two: its chest is our upper chest; its
//               spine begins at ours and points at the upper chest, so that programs which use the
//               rotations alone, as Rokoko's plugins do, hold shoulders and hands where they are.
//               A Skeleton does not know the lengths of fingers: those of an average hand, scaled
//               by the hand's own length.
#pragma once

#include "core/pose/pose.h"
#include "core/pose/skeleton.h"
#include "formats/rokoko/rokoko_frame.h"

namespace dance {

// Fills all but name and color. Fingers where hands are given.
void make_rokoko_actor(const Skeleton& skeleton, const Pose& pose, const Hands* hands,
                       RokokoActor& actor);

}  // namespace dance

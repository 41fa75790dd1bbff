// From an actor of Rokoko Studio to a figure and its fingers.
//
// Units/frames: figure and hands in W.
// Ownership:    plain values; never allocates.
// Threads:      none inside.
// Failure:      a joint that did not come is absent; hands_of() is false where no finger came.
#pragma once

#include "formats/rokoko/rokoko_frame.h"
#include "producers/receive/joint_figure.h"

namespace dance {

FigureFrame figure_of(const RokokoActor& actor);
bool hands_of(const RokokoActor& actor, const FigureFrame& figure, Hands& hands);

}  // namespace dance

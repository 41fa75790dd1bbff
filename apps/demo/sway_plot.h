// A picture of a demo's comparison: the hips' sway of both dancers over the beats of the music, in
// three rows of one axis: the local dancer, the remote dancer as the poses come, and as the stage
// shows them, each beside the dance as it was danced.
//
// Units/frames: centimetres over beats of the music in house A.
// Ownership:    plain values.
// Threads:      the one that draws.
// Failure:      tells what the graphics driver lacks, or the file that cannot be written.
#pragma once

#include <string>

#include "apps/demo/demo_rhythm.h"

namespace dance {

struct SwayPlot {
  SwayLines lines;
  DemoRhythm rhythm;
  std::string here, remote;  // names
};

Result<void> write_sway_plot(const std::string& file, const SwayPlot& plot);

}  // namespace dance

// By how much a shown dance is off the beat: the wave of the four-count in its motion, by lock-in
// over one bar, against the same wave in the dance as it was danced. The dancer's own wandering
// about the beat is in both and falls out: what is left is what the line and the stage did.
//
// Units/frames: musical time in beats, of the dancer's house for the truth, of the listener's for
//               what is shown; errors in beats, positive is late.
// Ownership:    owns its samples.
// Threads:      none inside.
// Failure:      where the motion has no four-count, or the shown one is not like the truth, there
//               is no error to tell: such moments are left out, and so are those whose bar has a
//               jump in it, as half of it is of another place of the dance; `told` says how many
//               were not.
#pragma once

#include <vector>

#include "testing/motion/motion_measures.h"

namespace dance {

// A dance on musical time: `beats` of each frame of the track.
struct DanceOnBeats {
  const JointTrack* track = nullptr;
  std::vector<double> beats;
  std::vector<double> jumps = {};  // beats at which it does not go on from the frame before
};

struct BeatPhase {
  double mean_beats = 0.0, sd_beats = 0.0;  // circular
  double told = 0.0;                        // share of the moments
  std::vector<double> errors_beats;         // of the moments that tell, in order
  std::vector<double> at_beats;
};

// `offset_beats` of each frame of `shown`: by how many beats it is known to be behind; a whole
// number where the stage plays on the beat. Frames [from, to) are looked at. Errors are folded to
// within half of `fold_beats`.
BeatPhase beat_phase(const DanceOnBeats& shown, const DanceOnBeats& truth,
                     const std::vector<double>& offset_beats, std::size_t from, std::size_t to,
                     double fold_beats = 1.0);

}  // namespace dance

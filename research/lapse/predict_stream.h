// A dance over a line with delay, jitter and loss, as a stage shows it: how late it looks, how far
// off it is, how smooth, and whether feet that stand slide.
//
// Units/frames: seconds, metres, ratios to the dance itself; frames at about 60 Hz.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      takes shorter than the warm-up and two seconds add nothing.
#pragma once

#include <string>
#include <vector>

#include "research/codec_takes.h"
#include "research/lapse/stage_subject.h"

namespace dance {

struct StreamFigures {
  double error_m =
      0.0;  // mean of the joints, the hips' place and rotation removed, against the dance of now
  double world_error_m = 0.0;                // nothing removed
  double lag_s = 0.0;                        // effective: the shift that fits best
  double jerk = 0.0;                         // of the joints in W / the dance's own
  double slide = 0.0;                        // of standing feet, at that lag / the dance's own
  double play_least = 0.0, play_most = 0.0;  // rate of the moments shown
  double seconds = 0.0;                      // that were judged
};

struct StreamOptions {
  Duration delay = Duration::ms(100);
  Duration jitter;  // mean of what is added to the delay
  double loss_percent = 0.0;
  std::size_t every = 1;  // each so many-th pose is sent: a sensor that is slower than the stage
  std::uint64_t seed = 1;
  Duration warm_up = Duration::s(4);
};

// Mean over the takes, by their length.
StreamFigures evaluate_stream(const std::vector<CodecTake>& takes, const MakeSubject& make,
                              const StreamOptions& options);

struct StreamRow {
  std::string subject;
  StreamFigures figures;
};
std::string stream_table(const std::vector<StreamRow>& rows);
std::string stream_json(const std::vector<StreamRow>& rows);

}  // namespace dance

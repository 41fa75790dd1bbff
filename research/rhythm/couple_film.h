// A recorded couple as the house of one of them shows it: the one dances here, the other comes over
// a line, and is shown in several ways, side by side, in one log that dance view and dance replay
// play.
//
// Units/frames: metres in W: each couple stands kBetween_m to the right of the one before. Times as
//               in research/rhythm/rhythm_eval.h.
// Ownership:    plain values; the sink is the caller's.
// Threads:      none inside; learners are run between poses.
// Failure:      a flow that cannot be made names the word.
#pragma once

#include <string>
#include <vector>

#include "formats/recording/recording_sink.h"
#include "research/rhythm/rhythm_eval.h"

namespace dance {

struct FilmedWay {
  std::string name;                  // of the guest: letters, digits, '-'
  std::vector<std::string> through;  // none: poses as they come
  bool is_truth = false;             // as danced, without a line
};

struct FilmOptions {
  Duration delay = Duration::ms(200);
  Duration jitter;
  double loss_percent = 0.0;
  double noise_deg = 0.0;
  std::uint64_t seed = 1;
  double hz = 60.0;
};

constexpr float kBetween_m = 2.4f;

// The ways that docs/prediction.md shows; with music, the one of rhythm too.
std::vector<FilmedWay> usual_ways(bool has_music);

// The names of the two dancers of a way; its name must be a guest's of at most 19 letters.
GuestId remote_of(const FilmedWay& way);
GuestId here_of(const FilmedWay& way);

// A take without music.
BeatDance as_danced(const CodecTake& take, double hz);

// `here` dances in the house, `remote` comes; both of the same moments. Without music (null) poses
// are not tagged.
Result<void> film_couple(const BeatDance& here, const BeatDance& remote, const BeatGrid* music,
                         const std::vector<FilmedWay>& ways, const FilmOptions& options,
                         const FlowParts& parts, RecordingSink& sink);

}  // namespace dance

// How well the stage keeps a remote dancer on the beat: a take is laid onto the beats of a song, as
// the sender danced to them, sent over a simulated line, and played by a flow of transformers in a
// house whose own music may run a little faster. Everything that is measured is measured on what
// was shown.
//
// Units/frames: stage and capture at `hz`; times of one clock, as after a link's clock mapping;
//               beats as core/base/beat.h.
// Ownership:    plain values.
// Threads:      none inside; learners are run between poses.
// Failure:      a flow that cannot be made names the word.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "producers/music/beat_grid.h"
#include "producers/salsa/salsa_style.h"
#include "research/codec_takes.h"
#include "research/rhythm/dance_beats.h"
#include "testing/motion/motion_measures.h"
#include "transformers/flow.h"

namespace dance {

// When the song and the dance begin.
constexpr MonoTime kRhythmEvalBegin = MonoTime::from_us(1'000'000'000);

struct RhythmEvalOptions {
  double hz = 60.0;
  Duration delay = Duration::ms(150);
  Duration jitter;
  double loss_percent = 0.0;
  double noise_deg = 0.0;             // of the sensor, about each axis of each bone
  std::size_t every = 1;              // so many-th pose alone is sent
  Duration stall;                     // one, in the middle
  double tempo_offset_percent = 0.0;  // the listener's music against the sender's
  bool untagged = false;
  std::uint64_t seed = 1;
  Duration warm_up = Duration::s(5);
};

// What one flow showed.
struct RhythmScore {
  double phase_mean_ms = 0.0, phase_sd_ms = 0.0, phase_told = 0.0;
  double content_delay_ms = 0.0;
  double mpjpe_mm = 0.0;  // against the dance as it is danced at that moment
  double jerk_ratio = 0.0, foot_slide_ratio = 0.0, bone_length_error_mm = 0.0;
  double least_rate = 0.0, most_rate = 0.0;
  double jumps = 0.0;    // changes of the moment by more than a rate can explain
  double jump_mm = 0.0;  // mean distance of the joints in W across them, in the dance
};

struct RhythmRun {
  std::string name;  // of the flow
  std::vector<RhythmScore> dances;
  RhythmScore mean;
  double phase_mean_ms_worst = 0.0, phase_sd_ms_worst = 0.0;
};

struct NamedFlow {
  std::string name;
  std::vector<std::string> through;  // none: poses as they come
  FlowParts parts = {};
};

// A dance to the song, from its first second on.
struct BeatDance {
  std::string name;
  Skeleton skeleton;
  std::vector<Pose> poses;    // tagged with the beats of the music that the dancer hears
  std::vector<double> beats;  // that each pose was danced to: the music's, or the dancer's own
  std::shared_ptr<const BeatDance> partner;  // who dances in the listener's house; null: nobody
};
// A take, stretched so that its own beats fall on those of the song.
BeatDance lay_onto_beats(const CodecTake& take, const BeatGrid& music, double hz);
// The same by beats that are known already, which wander as the dancers did.
BeatDance lay_onto_beats(const CodecTake& take, const DanceBeats& beats, const BeatGrid& music,
                         double hz);
// A synthetic salsa dancer, for as long as told; at a tempo of 0 to the song, else at a pace of its
// own.
BeatDance salsa_to_music(SalsaRole role, std::uint64_t seed, double tempo_bpm, Duration length,
                         const BeatGrid& music, double hz);

Result<RhythmRun> evaluate_rhythm(const std::vector<BeatDance>& dances, const BeatGrid& music,
                                  const NamedFlow& flow, const RhythmEvalOptions& options);

}  // namespace dance

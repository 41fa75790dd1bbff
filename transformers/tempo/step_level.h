// StepLevel: the tempo at which one person steps. The period of a dance is as strong at half of it
// and at twice; which of these is stepped is told by how far apart feet come to stand.
//
// Where music is heard, its tempo tells where to look, and nothing else: at that tempo, its half
// and its double alike, as what found the tempo may be wrong by an octave. A dance that is not
// periodic there tells nothing.
//
// Units/frames: steps a minute: a step is the time between feet that come to stand one after the
//               other, the most frequent one; so a dance that rests on each fourth step has it,
//               too.
// Ownership:    fixed arrays (about 200 kB); never allocates.
// Threads:      none inside; one owner.
// Failure:      sure() is 0 until some seconds of steps have been seen, while the feet stand, and
//               where they come to stand as often at one level as at another.
#pragma once

#include <array>
#include <cstddef>

#include "transformers/tempo/period.h"

namespace dance {

class StepLevel {
 public:
  // Of steps as of beats: a music of 72 is never stepped at 36.
  static constexpr double kSlowest_bpm = 70.0;
  static constexpr double kFastest_bpm = 216.0;

  void set_body(const Skeleton& skeleton) { period_.set_body(skeleton); }
  // Poses in the order of their capture; without musical time, or that is believed.
  void observe(const Pose& pose, MonoTime now);
  // Some times a second. music_bpm: of the music that is heard, at whatever level; 0: none.
  void judge(double music_bpm);
  void forget();

  double tempo_bpm() const { return tempo_bpm_; }  // 0: not known
  float sure() const { return sure_; }             // 0 not known … 1

 private:
  static constexpr std::size_t kFalls = 48;
  // How many of the last steps last so long, and by how much they do on average.
  struct Fit {
    double share = 0.0;
    double off_octaves = 0.0;
  };

  void take_steps();
  Fit fit_of(double step_s) const;
  double best_score() const;
  void look_near(double music_bpm);
  void look_everywhere();

  Period period_;
  std::array<MonoTime, kFalls> falls_{};  // newest first
  std::size_t fall_count_ = 0;
  std::uint64_t beats_seen_ = 0;
  std::array<double, kFalls> steps_s_{};
  std::size_t step_count_ = 0;
  double tempo_bpm_ = 0.0;
  float sure_ = 0.0f;
};

}  // namespace dance

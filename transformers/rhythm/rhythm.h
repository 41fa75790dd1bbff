// rhythm: a remote dancer on the beat that this house hears. Each pose carries where the dancer's
// own music stood; the stage shows pose(b - offset) when its music stands at b. The offset, whole
// beats, follows the room's wish: 0 shows the dancer now, where a guess fills what is still under
// way; a beat or two shows them true and late; by itself it takes the least delay that the measured
// guesses of this dancer allow. One scalar, the moment of the dance, drives root and all joints:
// contacts and bones stay what they were. The same moment goes on through stalls.
//
// Units/frames: beats of the music as core/base/beat.h counts them; moments are capture times, in
//               this house's clock.
// Ownership:    keeps the last 512 poses (8 s at 60 Hz) and 1024 tags; never allocates after
//               construction.
// Threads:      none inside; one owner.
// Failure:      without music here or there it shows what the station before it shows, or, as the
//               first of its chain, plays out as `hold` does. Poses that are not newer are refused
//               and counted.
// Source:       J. D. Ninjam's beat-quantised delay, for bodies; corrections by inertialization
//               (Bollo, GDC 2018).
#pragma once

#include "core/base/beat_clock.h"
#include "core/motion/finish.h"
#include "core/pose/history.h"
#include "transformers/playout/play_head.h"
#include "transformers/playout/play_out.h"
#include "transformers/predict/guess_meter.h"
#include "transformers/rhythm/beat_offset.h"
#include "transformers/rhythm/dance_line.h"
#include "transformers/rhythm/own_beat.h"
#include "transformers/transformer.h"

namespace dance {

struct RhythmOptions {
  double beats = -1.0;    // delay that the room wishes; negative: the least that guesses allow
  double count = 1.0;     // offsets are multiples of it: 4 keeps the bar, 8 a salsa's basic step
  double strength = 1.0;  // 0: untouched … 1: on the beat
  double most_error_m =
      0.06;  // a guess worse than that is not shown, where the delay is chosen here
};

class Rhythm : public Transformer {
 public:
  explicit Rhythm(const RhythmOptions& options = {});

  void observe(const Pose& pose, MonoTime now) override;
  bool sample(MonoTime now, Pose& out) override;
  MonoTime moment(MonoTime now) override;
  bool sample_at(MonoTime moment, MonoTime now, Pose& out) override;
  void hear(const Beat& beat, MonoTime now) override;
  void set_body(const Skeleton& skeleton) override;

  // On the beat at present; and by how many beats behind the dancer.
  bool is_in_time() const { return in_time_; }
  double offset_beats() const { return offset_.value(); }

 private:
  void restart();
  void take_tag(const Pose& pose, MonoTime now);
  void probe(MonoTime now);
  // The moment to show without music, and with it; the pace at which the latter goes on.
  MonoTime free_moment(MonoTime now);
  MonoTime wanted_moment(MonoTime now, double& pace);
  void choose_offset(MonoTime now);
  bool pose_at(MonoTime moment, MonoTime now, Pose& out);

  RhythmOptions options_;
  PoseHistory history_;
  DanceLine dance_;
  BeatClock music_;
  PlayOut play_out_;
  BeatOffset offset_;
  GuessMeter guesses_;
  OwnBeat own_beat_;
  PlayHead head_;
  Finish finish_;
  Pose shown_;  // before the finish
  MonoTime shown_moment_;
  std::uint32_t observed_ = 0, untagged_ = 0;
  bool has_shown_ = false, shown_is_guess_ = false, has_news_ = false, in_time_ = false;
};

}  // namespace dance

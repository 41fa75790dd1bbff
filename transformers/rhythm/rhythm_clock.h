// rhythm: a remote dancer on the beat that this house hears. Each pose carries where the dancer's
// own music stood; the stage shows pose(b - offset) when its music stands at b. The offset, whole
// beats, follows the room's wish: 0 shows the dancer now, where a prediction fills what is still
// under way; a beat or two shows them true and late; by itself it takes the least delay that the
// measured predictions of this dancer allow. One scalar, the moment of the dance, drives root and
// all joints: contacts and bones stay what they were. The same moment goes on through stalls.
//
// Units/frames: beats of the music as core/base/beat.h counts them; moments are capture times, in
//               this house's clock.
// Ownership:    owns the clock that it follows without music, and the last 1024 tags; never
//               allocates after construction.
// Threads:      none inside; one owner.
// Failure:      without music here or there it shows the moment of the free-running clock, or,
//               where there is none, plays out as `hold` does.
// Source:       J. D. Ninjam's beat-quantised delay, for bodies; corrections by inertialization
//               (Bollo, GDC 2018).
#pragma once

#include <memory>

#include "transformers/playout/play_head.h"
#include "transformers/playout/play_out.h"
#include "transformers/playout/playout_clock.h"
#include "transformers/predict/blend/prediction_meter.h"
#include "transformers/rhythm/beat_offset.h"
#include "transformers/rhythm/dancer_music.h"
#include "transformers/rhythm/own_beat.h"
#include "transformers/setting_slew.h"

namespace dance {

struct RhythmOptions {
  double beats = -1.0;    // delay that the room wishes; negative: the least that predictions allow
  double count = 1.0;     // offsets are multiples of it: 4 keeps the bar, 8 a salsa's basic step
  double strength = 1.0;  // 0: untouched … 1: on the beat
  double most_error_m =
      0.06;  // a prediction worse than that is not shown, where the delay is chosen here
};

class RhythmClock : public PlayoutClock {
 public:
  // `free_running`: the moment to show without music; may be null.
  explicit RhythmClock(const RhythmOptions& options = {},
                       std::unique_ptr<PlayoutClock> free_running = nullptr);

  void observe(const DancerTimeline& timeline, MotionSource& source) override;
  void restart() override;
  void on_music_jump() override { offset_.reset(); }
  void set_body(const Skeleton& skeleton) override;
  void set(const FlowSetting& setting) override;
  Choice choose(const DancerTimeline& timeline, MonoTime now, MonoTime shown) override;
  PredictionLead lead() const override { return lead_; }
  void explain(const DancerTimeline& timeline, MonoTime now, Playout& playout) const override;
  void tag(MonoTime moment, Pose& pose) const override;

  // On the beat at present; and by how many beats behind the dancer.
  bool is_in_time() const { return in_time_; }
  double offset_beats() const { return offset_.value(); }

 private:
  void take_tag(const DancerTimeline& timeline);
  void measure_predictions(const DancerTimeline& timeline, MotionSource& source);
  void set_gains();
  // The moment to show without music, and with it; the pace at which the latter goes on.
  MonoTime free_moment(const DancerTimeline& timeline, MonoTime now);
  MonoTime wanted_moment(const DancerTimeline& timeline, MonoTime now, double& pace);
  void choose_offset(const DancerTimeline& timeline, MonoTime now);

  RhythmOptions options_;
  SettingSlew strength_;
  std::unique_ptr<PlayoutClock> free_running_;
  DancerMusic dance_;
  PlayOut play_out_;
  BeatOffset offset_;
  PredictionMeter predictions_;
  OwnBeat own_beat_;
  PlayHead head_;
  PredictionLead lead_;
  SettingSlew lead_strength_{0.0};
  MonoTime probed_at_;
  std::uint32_t untagged_ = 0;
  bool in_time_ = false, has_own_beat_ = false;
};

}  // namespace dance

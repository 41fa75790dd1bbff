// MusicHere: the position of this house's music, for display and measurement: from its beats, or
// without any from the musical time of this house's own poses.
//
// Units/frames: beats as core/base/beat.h counts them; times of the clock that it is made with.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      beats and poses of other clocks are ignored; unknown 3 s after the last one.
#pragma once

#include <cmath>

#include "core/base/beat_clock.h"
#include "core/pose/pose.h"

namespace dance {

class MusicHere {
 public:
  explicit MusicHere(std::uint64_t clock_id) : clock_id_(clock_id) {}

  void hear(const Beat& beat) {
    if (beat.clock_id != clock_id_) return;
    clock_.hear(beat);
    said_ = beat.time;
  }
  // A pose captured in this house, while no beats come.
  void see(const Pose& pose) {
    if (pose.clock_id != clock_id_ || !std::isfinite(pose.music_beats)) return;
    if (said_.is_set() && pose.capture_time - said_ < kSaidHolds) return;
    const Duration since = pose.capture_time - seen_;
    if (seen_.is_set() && since > Duration() && since < kMeasured) return;
    const double tempo_bpm = 60.0 * (pose.music_beats - seen_beats_) / since.as_seconds();
    const bool is_music = seen_.is_set() && since > Duration() && since < kLapse &&
                          tempo_bpm >= kLeastTempo_bpm && tempo_bpm <= kMostTempo_bpm;
    seen_ = pose.capture_time;
    seen_beats_ = pose.music_beats;
    if (!is_music) return;
    Beat beat;
    beat.time = beat.beat_time = pose.capture_time;
    beat.clock_id = clock_id_;
    beat.beat = pose.music_beats;
    beat.tempo_bpm = tempo_bpm;
    beat.beats_per_bar = 4;  // an assumption
    beat.confidence = 0.5f;
    beat.playing = true;
    clock_.hear(beat);
  }

  const BeatClock& clock() const { return clock_; }

  // As BeatClock::carry().
  template <class Archive>
  void carry(Archive& archive) {
    clock_.carry(archive);
    archive(said_), archive(seen_), archive(seen_beats_);
  }

 private:
  static constexpr Duration kSaidHolds = Duration::s(3);
  static constexpr Duration kMeasured = Duration::ms(250);
  static constexpr Duration kLapse = Duration::s(3);

  std::uint64_t clock_id_;
  BeatClock clock_;
  MonoTime said_;
  MonoTime seen_;
  double seen_beats_ = 0.0;
};

}  // namespace dance

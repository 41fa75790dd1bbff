// StepScore: how many of the last ten beats that one dancer stepped on were met: a step came within
// the tolerance of the beat that is heard. A beat without a step is a rest and is not counted, as
// the 4 and 8 of salsa; of several steps round one beat the nearest counts.
//
// The tolerance is 100 ms, and at most a quarter of a beat. Practised dancers wander by 94 to
// 131 ms round their own mean, and what is seen may lead what is heard by 30 to 100 ms before it is
// noticed: a stricter bound would measure the camera and not the dancer. A quarter of a beat keeps
// steps at random at 5 of 10.
//
// Units/frames: beats of the music heard in this house; times of the poses' clock, which is the
//               music's. Late is positive, ms.
// Ownership:    fixed arrays (about 8 kB); never allocates.
// Threads:      none inside; one owner.
// Failure:      nothing is counted while no music is known. A jump of the music, or 16 beats
//               without a step, starts the count again.
#pragma once

#include <array>
#include <optional>

#include "core/base/beat_clock.h"
#include "transformers/tempo/motion_beats.h"
#include "transformers/tempo/motion_channels.h"

namespace dance {

class StepScore {
 public:
  static constexpr int kBeats = 10;
  static constexpr Duration kTolerance = Duration::ms(100);
  static constexpr double kTolerance_beats = 0.25;

  struct Figures {
    int counted = 0;                 // at most kBeats
    std::array<bool, kBeats> met{};  // oldest first
    float late_ms = 0.0f;            // mean of the counted
    int met_count() const;
  };

  void set_body(const Skeleton& skeleton) { channels_.set_body(skeleton); }
  // Poses in the order of their capture; what is not newer is passed over.
  void add(const Pose& pose, const BeatClock& music);
  Figures figures() const;

 private:
  struct Beat {
    double beat = 0.0;  // whole
    double late_beats = 0.0;
    double late_ms = 0.0;
  };
  void start_again();
  void note_step(double at, double beats_per_second);
  void close();

  MotionChannels channels_;
  MotionBeats steps_;
  MonoTime last_;
  double here_ = 0.0;         // where the music stood at the last pose
  std::optional<Beat> open_;  // a nearer step may still come
  std::array<Beat, kBeats> beats_{};
  std::size_t count_ = 0;
};

}  // namespace dance

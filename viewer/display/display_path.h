// DisplayPath: when to take the poses of a picture, so that they are as new as can be when the
// display shows it (late latching), and when its light will be seen.
//
// It first draws without delay, so that swap calls wait and show the display's turns
// (DisplayClock); then each picture's poses are taken just so long before a turn as drawing takes.
// Where swap calls never wait (no display to wait for, or a driver that queues), pictures come at
// the monitor's rate, and poses are taken right before drawing. Without late latching poses are
// always taken at once, and the clock only tells when the light is seen.
//
// Units/frames: MonoTime of this process.
// Ownership:    plain value; allocates nothing.
// Threads:      none inside; the drawing thread owns it.
// Failure:      none: what cannot be measured falls back to the pace of the monitor's rate.
#pragma once

#include <array>
#include <optional>

#include "viewer/display/display_clock.h"

namespace dance {

// One picture's moments, in this order.
struct PictureTimes {
  MonoTime taken;    // poses
  MonoTime drawn;    // the graphics card has finished
  MonoTime swapped;  // the swap call came back
};

class DisplayPath {
 public:
  struct Options {
    bool is_late_latching = true;
    std::optional<Duration> latency;  // from the display's turn to light; default half a period
  };
  // kAtOnce: the display's turns are known, and late latching is off.
  enum class Phase { kLearning, kLatched, kAtOnce, kOwnPace };

  DisplayPath(Duration nominal_period, const Options& options);

  // When to take the next picture's poses; `now` at the latest once it has passed.
  MonoTime when_to_take(MonoTime now);
  // When the middle of a picture is seen whose poses are taken now.
  MonoTime photon_time(MonoTime taken) const;
  void on_picture(const PictureTimes& times);
  // Another display mode or monitor: all is learnt anew.
  void start_over(Duration nominal_period, const Options& options);

  Phase phase() const { return phase_; }
  Duration period() const { return clock_.period(); }
  // What the monitor says of itself.
  Duration nominal_period() const { return nominal_; }
  bool knows_turns() const { return clock_.is_locked(); }
  // What is set aside for drawing, without the margin.
  Duration drawing_time() const { return drawing_; }
  Duration margin() const { return margin_; }
  std::uint64_t missed() const { return missed_; }  // turns of the display

 private:
  static constexpr std::size_t kDrawings = 64;
  void learn(const PictureTimes& times);
  void judge(const PictureTimes& times);
  void note_drawing(Duration drawing);
  void begin_learning();
  Duration set_aside() const { return drawing_ + margin_; }

  Options options_;
  Duration nominal_;
  DisplayClock clock_;
  Phase phase_ = Phase::kLearning;
  MonoTime turn_;       // that the next picture is for; latched only
  MonoTime last_turn_;  // of the picture before
  MonoTime last_taken_;
  MonoTime phase_since_;
  int learnt_ = 0;  // pictures of this learning
  int waited_ = 0;  // of these, whose swap waited
  int late_in_a_row_ = 0;
  std::array<Duration, kDrawings> drawings_{};
  std::size_t drawn_ = 0;
  Duration drawing_ = Duration::ms(4);
  Duration margin_ = Duration::us(1'500);
  std::uint64_t missed_ = 0;
};

}  // namespace dance

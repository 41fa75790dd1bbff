// ReplayPlayer: where a recording is being played: playing or paused, how fast, in which loop. What
// a person can ask of a video player, and of one that knows the music.
//
// Units/frames: moments in the recorded house's clock; the person's time is told as steps.
// Ownership:    shares the index.
// Threads:      none inside; the drawing thread.
// Failure:      none; what lies outside the recording is held at its ends.
#pragma once

#include <memory>
#include <optional>

#include "formats/replay/replay_index.h"

namespace dance {

class ReplayPlayer {
 public:
  static constexpr double kSlowest = 0.1;
  static constexpr double kFastest = 4.0;

  explicit ReplayPlayer(std::shared_ptr<const ReplayIndex> index);

  const ReplayIndex& index() const { return *index_; }
  MonoTime position() const { return position_; }
  double seconds() const { return (position_ - index_->begin).as_seconds(); }
  double length_s() const { return (index_->end - index_->begin).as_seconds(); }
  bool is_playing() const { return is_playing_; }
  double speed() const { return speed_; }
  bool loops() const { return loops_; }
  // The loop's ends where they were set; else those of the recording.
  std::optional<MonoTime> loop_begin() const { return loop_begin_; }
  std::optional<MonoTime> loop_end() const { return loop_end_; }
  MonoTime range_begin() const { return loop_begin_.value_or(index_->begin); }
  MonoTime range_end() const { return loop_end_.value_or(index_->end); }

  // The person's time has gone on. At the end of the loop, or of the recording, it begins again.
  void advance(Duration passed);

  void toggle_playing() { is_playing_ = !is_playing_; }
  void set_playing(bool plays) { is_playing_ = plays; }
  void go_to(MonoTime moment);
  void jump(Duration by) { go_to(position_ + by); }
  // Pauses, and goes so many frames on or back, as most guests have them a second.
  void step_frames(int frames);
  // To the next or an earlier beat, or first beat of a bar.
  void jump_beats(int beats) { jump_marks(beats, false); }
  void jump_bars(int bars) { jump_marks(bars, true); }
  // Along 0.1, 0.25, 0.5, 0.75, 1, 1.5, 2, 3, 4.
  void change_speed(int steps);
  void set_speed(double speed);
  // The end before the beginning moves the beginning away, and the other way round.
  void set_loop_begin();
  void set_loop_end();
  void clear_loop();
  void toggle_loop() { loops_ = !loops_; }

  double frame_hz() const { return frame_hz_; }

 private:
  void jump_marks(int count, bool bars);

  std::shared_ptr<const ReplayIndex> index_;
  MonoTime position_;
  bool is_playing_ = true;
  bool loops_ = false;
  double speed_ = 1.0;
  double frame_hz_ = 60.0;
  std::optional<MonoTime> loop_begin_, loop_end_;
};

bool is_bar(const ReplayIndex::WholeBeat& beat);

}  // namespace dance

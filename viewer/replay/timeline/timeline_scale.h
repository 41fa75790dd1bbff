// TimelineScale: which part of a recording a timeline shows, and which marks it has room for: times
// in round steps, beats or bars or every so many bars.
//
// Units/frames: pixels from the left; moments in the recorded house's clock.
// Ownership:    plain values; marks are computed on demand.
// Threads:      none inside.
// Failure:      none; a part is never shorter than kShortest nor outside the recording.
#pragma once

#include <string>
#include <vector>

#include "formats/replay/replay_index.h"

namespace dance {

class TimelineScale {
 public:
  static constexpr Duration kShortest = Duration::ms(500);

  TimelineScale(MonoTime begin, MonoTime end) : begin_(begin), end_(end), from_(begin), to_(end) {}

  void set_width(float left_px, float right_px) { left_px_ = left_px, right_px_ = right_px; }
  MonoTime from() const { return from_; }
  MonoTime to() const { return to_; }
  bool is_whole() const { return from_ == begin_ && to_ == end_; }
  float x_of(MonoTime moment) const;
  MonoTime moment_at(float x_px) const;
  double pixels_per_second() const;

  // Shows a longer or shorter part; what is at x_px stays there.
  void zoom(float notches, float x_px);
  void show_all() { from_ = begin_, to_ = end_; }
  // Moves the part so that the moment is in it.
  void follow(MonoTime moment);

  // Seconds between labelled times that are at least so far apart.
  double label_step_s(float least_px) const;

 private:
  void hold(Duration length);

  MonoTime begin_, end_, from_, to_;
  float left_px_ = 0.0f, right_px_ = 1.0f;
};

// "1:05", "1:05.3" or "1:02:05", as the step between times needs it.
std::string clock_text(double seconds, double step_s);

// A beat that the timeline marks.
struct BeatTick {
  MonoTime time;
  bool is_bar = false;
  int bar = 0;  // counted from 1
  bool has_label = false;
};

// Beats within the scale's part, thinned out until they are least_px apart; labels label_px.
std::vector<BeatTick> beat_ticks(const std::vector<ReplayIndex::WholeBeat>& beats,
                                 const TimelineScale& scale, float least_px, float label_px);

// "bar 17, beat 3" of a moment, "" where there is no music.
std::string bar_text(const std::vector<ReplayIndex::WholeBeat>& beats, MonoTime moment);
// Beats a minute there; 0 where there is no music.
double tempo_at(const std::vector<ReplayIndex::WholeBeat>& beats, MonoTime moment);

}  // namespace dance

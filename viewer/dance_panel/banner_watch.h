// BannerWatch: gathers, picture by picture, since when what may be wrong is so.
//
// Units/frames: MonoTime of the house's clock.
// Ownership:    plain value.
// Threads:      the drawing thread.
// Failure:      none.
#pragma once

#include "viewer/dance_panel/banner.h"
#include "viewer/dance_panel/clock_watch.h"
#include "viewer/dance_panel/dance_records.h"

namespace dance {

// SlowNote decides when to show the note that this machine draws slowly: once per window, and only
// after fewer pixels have been tried (viewer/display/render_scale.h).
class SlowNote {
 public:
  static constexpr Duration kSlow = Duration::s(5);
  static constexpr Duration kShown = Duration::s(15);

  // Call it once a picture. `was_shown` becomes true when the note appears.
  bool is_shown(Duration slow_for, bool& was_shown, MonoTime now) {
    if (!was_shown && slow_for > kSlow) {
      was_shown = true;
      until_ = now + kShown;
    }
    return until_.is_set() && now < until_;
  }
  void close() { until_ = MonoTime(); }

 private:
  MonoTime until_;  // not set: not shown
};

class BannerWatch {
 public:
  // What the window knows of itself.
  struct Drawing {
    bool is_software = false;          // drawn by the processor
    bool is_plain = false;             // --quality low
    bool is_at_smallest_scale = true;  // viewer/display/render_scale.h has nothing left to try
    float pictures_hz = 60.0f;
  };

  // Once a picture. `wall` is the machine's wall clock.
  const BannerFacts& update(const DanceRecords& records, const SceneState& scene,
                            const Drawing& drawing, Duration wall, MonoTime now);
  void set_recording_trouble(std::string trouble) { facts_.recording_trouble = std::move(trouble); }
  const BannerFacts& facts() const { return facts_; }

 private:
  // How long something has been so.
  class Since {
   public:
    Duration update(bool is_so, MonoTime now) {
      if (!is_so) since_ = MonoTime();
      if (is_so && !since_.is_set()) since_ = now;
      return is_so ? now - since_ : Duration();
    }

   private:
    MonoTime since_;
  };

  void watch_link(const DanceRecords& records, MonoTime now);
  void watch_poses(const DanceRecords& records, MonoTime now);
  void watch_voice(const DanceRecords& records, const SceneState& scene, MonoTime now);

  BannerFacts facts_;
  Since down_, slow_, silent_, muted_speech_;
  MonoTime spoke_;  // while muted, last
  ClockWatch clock_;
  MonoTime clock_looked_, clock_jumped_;
};

}  // namespace dance

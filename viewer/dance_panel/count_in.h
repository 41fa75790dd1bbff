// CountIn: "5 6 7 8" before the next bar, when somebody asks for it, so that all begin together.
//
// Units/frames: beats as the music counts them.
// Ownership:    plain value.
// Threads:      none inside; the drawing thread.
// Failure:      without music, or with music whose bar is not known, there is nothing to count;
//               music that jumps ends the count.
#pragma once

#include <cmath>
#include <optional>

#include "viewer/scene/scene.h"

namespace dance {

class CountIn {
 public:
  static bool is_possible(const std::optional<SceneMusic>& music) {
    return music && music->beats_per_bar > 0 && std::isfinite(music->beats);
  }
  // Begins with the next bar that has not begun, and ends with the one after it.
  void ask(const std::optional<SceneMusic>& music) {
    if (!is_possible(music)) return;
    const double bar = music->beats_per_bar;
    begins_ = std::ceil(music->beats / bar) * bar;
    asked_at_ = music->beats;
    is_asked_ = true;
  }
  void stop() { is_asked_ = false; }
  // While it waits for that bar, too.
  bool is_asked() const { return is_asked_; }

  struct Count {
    int number = 0;      // of a dancer: 5 to 8 of a bar of four, then 1
    float since = 0.0f;  // the beat began, in beats: 0 to 1
    bool is_one = false;
  };
  // What is to be shown now. Call once a picture.
  std::optional<Count> at(const std::optional<SceneMusic>& music) {
    if (!is_asked_) return std::nullopt;
    if (!is_possible(music) || music->beats < asked_at_ - kBack_beats ||
        music->beats > begins_ + music->beats_per_bar + 1.0) {
      stop();
      return std::nullopt;
    }
    const double since = music->beats - begins_;
    if (since < 0.0) return std::nullopt;
    const int beat = static_cast<int>(since);
    Count count;
    count.is_one = beat >= music->beats_per_bar;
    count.number = count.is_one ? 1 : music->beats_per_bar + beat + 1;
    count.since = static_cast<float>(since - beat);
    return count;
  }

 private:
  static constexpr double kBack_beats = 0.5;  // what the clock may take back

  double begins_ = 0.0;
  double asked_at_ = 0.0;
  bool is_asked_ = false;
};

}  // namespace dance

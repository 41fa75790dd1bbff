// MusicPlayer: plays a song, or keeps its time, so that its second 0 is or was heard at a given
// moment.
//
// Units/frames: song seconds as in producers/music/song.h; times of this house's clock.
// Ownership:    of each implementation.
// Threads:      none inside; runs in the program's loop.
// Failure:      work() fails where playing cannot go on.
#pragma once

#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

class MusicPlayer {
 public:
  virtual ~MusicPlayer() = default;
  // May be called again at any time with another moment. Loops, or is silent after the end.
  virtual void play_from(MonoTime begin, bool loops) = 0;
  virtual void pause() = 0;
  // From now on: 0 = silent, 1 = as in the file.
  virtual void set_volume(double volume) = 0;
  // Song seconds are those of this speed from now on; play_from() follows.
  virtual void set_speed(double /*speed*/) {}
  // The song second that is heard at t; nullopt while that is not known.
  virtual std::optional<double> heard_s(MonoTime t) const = 0;
  // To be called a hundred times a second.
  virtual Result<void> work(MonoTime now) = 0;
  // One line of statistics for the end.
  virtual std::string summary() const = 0;
};

// Keeps the time only: for machines without sound.
class SilentPlayer : public MusicPlayer {
 public:
  void play_from(MonoTime begin, bool /*loops*/) override { begin_ = begin; }
  void pause() override { begin_.reset(); }
  void set_volume(double) override {}
  std::optional<double> heard_s(MonoTime t) const override {
    return begin_ ? std::optional((t - *begin_).as_seconds()) : std::nullopt;
  }
  Result<void> work(MonoTime) override { return {}; }
  std::string summary() const override { return "kept the time without sound"; }

 private:
  std::optional<MonoTime> begin_;
};

}  // namespace dance

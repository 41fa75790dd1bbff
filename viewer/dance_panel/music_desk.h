// MusicDesk: how loud and how fast the music of this house is: told to what plays it while a person
// moves a slider. The volume is kept in the session file when it has rested, the speed is not.
//
// Units/frames: volumes and speeds are factors, 0 = silent, 1 = as in the file.
// Ownership:    plain value; what the functions refer to must outlive it.
// Threads:      the drawing thread.
// Failure:      what cannot be told or kept is in trouble().
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

// A request to the house band.
enum class BandRequest : std::uint8_t {
  kNext,
  kPlay,
  kPause,
  kSlower,
  kFaster,
  kStyle,
  kLock,
  kUnlock
};

class MusicDesk {
 public:
  static constexpr Duration kLook = Duration::s(1);
  static constexpr Duration kRests = Duration::ms(700);

  struct Needs {
    std::function<bool()> plays_here;  // a program of this house plays music; not set = never
    std::function<Result<void>(double)> tell;
    std::function<Result<void>(double)> keep;
    double volume = 1.0;  // as the session file has it
    // `style` counts for kStyle only; numbered as in lcmtypes/song_t.lcm.
    std::function<Result<void>(BandRequest, int style)> control_band = {};
    // Sets the speed of a file that this house plays alone.
    std::function<Result<void>(double)> send_speed = {};
  };
  explicit MusicDesk(Needs needs) : needs_(std::move(needs)), volume_(needs_.volume) {}

  // Once a picture.
  void work(bool is_shown, MonoTime now);
  bool is_there() const { return is_there_; }
  double volume() const { return volume_; }
  void set(double volume, MonoTime now);  // no longer muted
  // Mutes or unmutes the music of this house. The choice is not saved: the next dance has music.
  void toggle_mute();
  bool is_muted() const { return is_muted_; }
  double speed() const { return speed_; }
  // Speeds are in steps of music_speed.h; each change is sent once.
  void set_speed(double speed);
  void control_band(BandRequest request, int style);
  // What has not been kept yet.
  void keep();
  const std::string& trouble() const { return trouble_; }

 private:
  void tell(double volume);

  Needs needs_;
  double volume_;
  double speed_ = 1.0;
  bool is_there_ = false;
  bool is_muted_ = false;
  MonoTime looked_, changed_;  // changed_: not set where all is kept
  std::string trouble_;
};

}  // namespace dance

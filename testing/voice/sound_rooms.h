// A sound server of a test's or benchmark's own with rooms in it: null sinks, into which sound is
// played as by a mouth, and whose monitors are heard as by an ear or a microphone.
//
// Units/frames: mono at 48 kHz; times of this machine's monotonic clock.
// Ownership:    the server ends with the object; PULSE_SERVER of this process names it meanwhile,
//               and HOME and XDG_RUNTIME_DIR are its folder, for children too.
// Threads:      one.
// Failure:      open() names what is missing and the cure.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/program/child_process.h"
#include "core/sound/pulse_input.h"
#include "core/sound/pulse_output.h"

namespace dance {

class SoundRooms {
 public:
  static bool is_there();
  // What one sink plays is played by another too, 30 ms later: as a loudspeaker into a microphone.
  struct Leak {
    std::string from, to;
  };
  // Each sink has a monitor, <sink>.monitor. `folder` is there and this process's own.
  static Result<std::unique_ptr<SoundRooms>> open(const std::string& folder,
                                                  const std::vector<std::string>& sinks,
                                                  const std::vector<Leak>& leaks = {});
  ~SoundRooms();
  SoundRooms(const SoundRooms&) = delete;
  SoundRooms& operator=(const SoundRooms&) = delete;

  // Plays all of it into the sink, once, from now on.
  Result<void> play(const std::string& sink, std::vector<float> mono);
  // Hears the sink from now on.
  Result<std::size_t> listen(const std::string& sink);
  // To be called every few milliseconds.
  void work(MonoTime now);
  bool has_played() const;
  // What an ear has heard from `begin` on, sample by sample of this machine's clock; silence where
  // it had not begun.
  std::vector<float> heard(std::size_t ear, MonoTime begin, Duration length) const;
  std::size_t heard_samples(std::size_t ear) const { return ears_[ear]->samples.size(); }

 private:
  struct Mouth {
    std::vector<float> mono;
    std::size_t at = 0;
    std::unique_ptr<PulseOutput> output;
  };
  struct Ear {
    std::vector<float> samples;
    std::unique_ptr<PulseInput> input;
  };

  SoundRooms() = default;

  std::vector<std::optional<std::string>> before_;  // of the environment
  std::unique_ptr<ChildProcess> child_;
  std::unique_ptr<PulseServer> server_;
  std::vector<std::unique_ptr<Mouth>> mouths_;
  std::vector<std::unique_ptr<Ear>> ears_;
  MonoTime next_timing_;
};

}  // namespace dance

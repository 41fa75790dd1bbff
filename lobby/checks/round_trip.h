// RoundTripMeter: how long a sound takes from this program through the loudspeaker, the room and
// the microphone back to it, and how loud it comes back: a sweep is played and looked for in what
// the microphone hears, by correlation.
//
// Units/frames: mono samples at 48 kHz of the microphone, counted from its begin; times of this
//               machine's monotonic clock.
// Ownership:    owns two seconds of sound, allocated once.
// Threads:      none inside.
// Failure:      a sweep that is not found is no echo: is_heard is false.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/time.h"

namespace dance {

struct RoundTrip {
  bool is_heard = false;
  Duration delay;         // from handing the sweep to the sound server until it was read again
  float echo_db = 0.0f;   // how loud it came back beside how it was played
  float likeness = 0.0f;  // of what was found to the sweep, 0 to 1
};

class RoundTripMeter {
 public:
  static constexpr double kLongest_s = 1.0;

  RoundTripMeter();
  // The sweep's first sample was handed over just now.
  void begin(MonoTime played);
  // What the microphone has heard since; `read`: when the last of them was read.
  void hear(std::span<const float> samples, MonoTime read);
  bool is_listening() const { return is_listening_; }
  // Once, when enough was heard.
  std::optional<RoundTrip> take();

 private:
  RoundTrip find() const;

  bool is_listening_ = false;
  MonoTime played_;
  std::optional<MonoTime> first_;  // when the first sample that is kept came
  std::vector<float> heard_;
  std::optional<RoundTrip> found_;
};

// Where the sweep is in the sound, and how alike it is there. Pure.
struct SweepPlace {
  std::size_t at = 0;
  float likeness = 0.0f;
  float gain = 0.0f;  // of it
};
SweepPlace find_sweep(std::span<const float> heard);

}  // namespace dance

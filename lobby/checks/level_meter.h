// LevelMeter: how loud a microphone's samples are, in windows of 50 ms, with the peak held for a
// bar that people can read; and whether it has been silent or too loud for a while.
//
// Units/frames: mono samples at 48 kHz, -1 to 1; levels in dB of full scale (dBFS), -100 at least.
// Ownership:    plain values; allocates nothing.
// Threads:      none inside.
// Failure:      samples that are not finite count as 0.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace dance {

constexpr double kCheckRate_hz = 48'000.0;
constexpr float kQuietest_db = -100.0f;

struct SoundLevel {
  float rms_db = kQuietest_db;
  float peak_db = kQuietest_db;
  float held_db = kQuietest_db;  // the highest peak of the last second and a half, then falling
  bool is_silent = false;        // below -70 dB, or zeros, for three seconds
  bool is_heard = false;         // above -45 dB within the last ten seconds
  bool clips = false;            // within the last three seconds
  std::uint64_t windows = 0;     // so far
};

class LevelMeter {
 public:
  static constexpr std::size_t kWindow = 2400;  // samples

  void add(std::span<const float> samples);
  const SoundLevel& level() const { return level_; }
  void reset() { *this = LevelMeter(); }

 private:
  void end_window();

  SoundLevel level_;
  std::size_t count_ = 0;
  double squares_ = 0.0;
  float peak_ = 0.0f;
  int full_ = 0;              // samples at full scale, one behind the other
  bool has_clipped_ = false;  // in this window
  // Windows since that was so.
  int since_held_ = 0;
  int since_sound_ = 0;
  int since_voice_ = 1 << 20;
  int since_clip_ = 1 << 20;
};

}  // namespace dance

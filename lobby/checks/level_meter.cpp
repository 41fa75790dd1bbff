#include "lobby/checks/level_meter.h"

#include <cmath>

namespace dance {
namespace {

constexpr int kWindowsInSecond = 20;
constexpr int kHold = kWindowsInSecond * 3 / 2;
constexpr float kFall_db = 1.0f;  // a window
constexpr int kSilentFor = kWindowsInSecond * 3;
constexpr float kSilent_db = -70.0f;
constexpr int kHeardWithin = kWindowsInSecond * 10;
constexpr float kHeard_db = -45.0f;
constexpr int kClippedWithin = kWindowsInSecond * 3;
constexpr float kFull = 0.995f;
constexpr int kFullInARow = 3;  // a single one may be a voice's own peak

float db_of(double amplitude) {
  if (!(amplitude > 1e-5)) return kQuietest_db;
  return static_cast<float>(20.0 * std::log10(amplitude));
}

}  // namespace

void LevelMeter::add(std::span<const float> samples) {
  for (const float sample : samples) {
    const float size = std::isfinite(sample) ? std::abs(sample) : 0.0f;
    squares_ += static_cast<double>(size) * static_cast<double>(size);
    peak_ = std::max(peak_, size);
    full_ = size >= kFull ? full_ + 1 : 0;
    if (full_ >= kFullInARow) has_clipped_ = true;
    if (++count_ == kWindow) end_window();
  }
}

void LevelMeter::end_window() {
  const auto tick = [](int& since, bool is_now) {
    since = is_now ? 0 : std::min(since + 1, 1 << 20);
  };
  level_.rms_db = db_of(std::sqrt(squares_ / kWindow));
  level_.peak_db = db_of(static_cast<double>(peak_));
  ++since_held_;
  if (level_.peak_db >= level_.held_db) {
    level_.held_db = level_.peak_db;
    since_held_ = 0;
  } else if (since_held_ > kHold) {
    level_.held_db = std::max(level_.peak_db, level_.held_db - kFall_db);
  }
  tick(since_sound_, level_.rms_db > kSilent_db);
  tick(since_voice_, level_.rms_db > kHeard_db);
  tick(since_clip_, has_clipped_);
  level_.is_silent = since_sound_ >= kSilentFor;
  level_.is_heard = since_voice_ < kHeardWithin;
  level_.clips = since_clip_ < kClippedWithin;
  ++level_.windows;
  count_ = 0;
  squares_ = 0.0;
  peak_ = 0.0f;
  has_clipped_ = false;
}

}  // namespace dance

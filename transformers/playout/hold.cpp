#include "transformers/playout/hold.h"

#include <algorithm>

namespace dance {
namespace {

constexpr std::size_t kHistoryPoses = 256;  // 4 s at 60 Hz, 2 s at 120 Hz
constexpr Duration kRestart = Duration::s(1);
// The stage's time runs at most this much faster or slower while the delay changes: not visible in
// a dance.
constexpr double kSlewRate = 0.05;
// While the line is not known yet, to be in time soon.
constexpr double kFirstSlewRate = 0.25;
constexpr Duration kFirst = Duration::s(2);
// A change so large is a new line or a new clock, not jitter: jump.
constexpr Duration kJump = Duration::ms(500);
// What a window finds by itself. Beyond, a dancer is better guessed than waited for.
constexpr Duration kLongestWindow = Duration::ms(250);

}  // namespace

Hold::Hold(std::optional<Duration> window) : window_(window), history_(kHistoryPoses) {}

void Hold::observe(const Pose& pose, MonoTime now) {
  if (!history_.empty()) {
    const Pose& newest = history_.newest();
    if (pose.clock_id != newest.clock_id || pose.capture_time < newest.capture_time - kRestart) {
      ++counters_.restarts;
      history_.clear();
      shown_ = MonoTime();
      transit_.forget();
      has_delay_ = false;
      play_out_.forget();
    }
  }
  const MonoTime before = history_.empty() ? pose.capture_time : history_.newest().capture_time;
  if (!history_.push(pose)) {
    ++counters_.refused;
    return;
  }
  transit_.add(now - pose.capture_time, now);
  if (!window_) play_out_.add(pose.capture_time - before, now - pose.capture_time);
}

Duration Hold::target() const {
  const Duration least = transit_.value();
  return window_ ? least + *window_ : std::clamp(play_out_.needed(), least, least + kLongestWindow);
}

void Hold::follow_target(MonoTime now) {
  const Duration error = target() - delay_;
  if (!has_delay_ || error > kJump || error < -kJump) {
    delay_ = target();
    if (!has_delay_) begin_ = now;
    has_delay_ = true;
  } else {
    const double rate = !window_ && now - begin_ < kFirst ? kFirstSlewRate : kSlewRate;
    const Duration most = Duration::seconds((now - delay_set_).as_seconds() * rate);
    delay_ += std::clamp(error, -most, most);
  }
  delay_set_ = now;
}

MonoTime Hold::moment(MonoTime now) {
  if (history_.empty()) return now;
  follow_target(now);
  return now - delay_;
}

bool Hold::sample_at(MonoTime moment, MonoTime /*now*/, Pose& out) {
  const auto answer = history_.at(moment);
  if (!answer) return false;
  out = answer->pose;
  return true;
}

bool Hold::sample(MonoTime now, Pose& out) {
  if (history_.empty()) return false;
  // A delay that jumps up would have the dance go back: it stands still until its time comes again.
  const MonoTime wanted = moment(now);
  const auto answer = history_.at_for_good(std::max(wanted, shown_));
  out = answer->pose;
  if (answer->how == PoseHistory::How::kHeldLast || wanted < shown_) ++counters_.starved;
  shown_ = out.capture_time;
  return true;
}

}  // namespace dance

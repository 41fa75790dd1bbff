#include "transformers/hold.h"

#include <algorithm>

namespace dance {
namespace {

constexpr std::size_t kHistoryPoses = 256;  // 4 s at 60 Hz, 2 s at 120 Hz
constexpr Duration kRestart = Duration::s(1);
// The stage's time runs at most this much faster or slower while the delay changes: not visible in a dance.
constexpr double kSlewRate = 0.05;
// A change so large is a new line or a new clock, not jitter: jump.
constexpr Duration kJump = Duration::ms(500);

}  // namespace

Hold::Hold(Duration window) : window_(window), history_(kHistoryPoses) {}

void Hold::observe(const Pose& pose, MonoTime now) {
  if (!history_.empty()) {
    const Pose& newest = history_.newest();
    if (pose.clock_id != newest.clock_id || pose.capture_time < newest.capture_time - kRestart) {
      ++counters_.restarts;
      history_.clear();
      buckets_ = {};
      has_delay_ = false;
    }
  }
  if (!history_.push(pose)) {
    ++counters_.refused;
    return;
  }
  note_transit(now - pose.capture_time, now);
}

void Hold::note_transit(Duration transit, MonoTime now) {
  if (!buckets_[0].filled || now - bucket_begin_ > kBucketLength) {
    buckets_[1] = buckets_[0];
    buckets_[0] = {transit, true};
    bucket_begin_ = now;
  }
  buckets_[0].least = std::min(buckets_[0].least, transit);
}

Duration Hold::least_transit() const {
  return buckets_[1].filled ? std::min(buckets_[0].least, buckets_[1].least) : buckets_[0].least;
}

void Hold::follow_target(MonoTime now) {
  const Duration target = least_transit() + window_;
  const Duration error = target - delay_;
  if (!has_delay_ || error > kJump || error < -kJump) {
    delay_ = target;
    has_delay_ = true;
  } else {
    const Duration most = Duration::seconds((now - delay_set_).as_seconds() * kSlewRate);
    delay_ += std::clamp(error, -most, most);
  }
  delay_set_ = now;
}

bool Hold::sample(MonoTime now, Pose& out) {
  if (history_.empty()) return false;
  follow_target(now);
  const MonoTime moment = now - delay_;
  const auto answer = history_.at(moment);
  out = answer->pose;
  if (answer->how == PoseHistory::How::kHeldLast) ++counters_.starved;
  return true;
}

}  // namespace dance

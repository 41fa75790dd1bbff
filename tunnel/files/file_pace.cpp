#include "tunnel/files/file_pace.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr double kLeastShare = 1.0 / 32.0;
constexpr double kRecovery_per_s = 0.2;  // so much more each second
constexpr float kMuchLost = 0.1f;  // below that it is the path's own, and slower would not help
constexpr Duration kWindow = Duration::s(30);
// What one slow-down has done shows after a round trip or two.
constexpr Duration kBetweenSlowDowns = Duration::ms(500);
constexpr Duration kQueueing = Duration::ms(20);

}  // namespace

FilePace::FilePace(double bytes_per_second, double burst_bytes)
    : rate_(bytes_per_second), burst_(burst_bytes), level_(burst_bytes) {}

void FilePace::fill(MonoTime now) {
  if (filled_at_.is_set() && now > filled_at_) {
    const double elapsed_s = (now - filled_at_).as_seconds();
    level_ = std::min(burst_, level_ + bytes_per_second() * elapsed_s);
    share_ = std::min(1.0, share_ * std::exp(kRecovery_per_s * std::min(elapsed_s, 1.0)));
  }
  if (!filled_at_.is_set() || now > filled_at_) filled_at_ = now;
}

bool FilePace::has(double bytes, MonoTime now) {
  fill(now);
  return rate_ > 0.0 && level_ >= bytes;
}

bool FilePace::take(double bytes, MonoTime now) {
  if (!has(bytes, now)) return false;
  level_ -= bytes;
  return true;
}

MonoTime FilePace::ready_at(double bytes) const {
  if (rate_ <= 0.0 || bytes > burst_) return MonoTime();
  if (!filled_at_.is_set() || level_ >= bytes) return MonoTime::from_ns(1);
  // A little more, lest rounding wakes it too early.
  const Duration wait = Duration::seconds((bytes - level_) / bytes_per_second()) + Duration::us(10);
  return filled_at_ + wait;
}

void FilePace::see_round_trip(Duration round_trip, MonoTime now) {
  if (round_trip <= Duration()) return;
  if (!window_begin_.is_set() || now - window_begin_ > kWindow) {
    shortest_before_ = shortest_;
    shortest_ = round_trip;
    window_begin_ = now;
  }
  shortest_ = std::min(shortest_, round_trip);
  const Duration shortest =
      shortest_before_ > Duration() ? std::min(shortest_, shortest_before_) : shortest_;
  if (round_trip > shortest + shortest / 4 + kQueueing) slow_down(now);
}

void FilePace::see_loss(MonoTime now) {
  see(1.0f);
  if (lost_share_ > kMuchLost) slow_down(now);
}

void FilePace::slow_down(MonoTime now) {
  if (slowed_at_.is_set() && now - slowed_at_ < kBetweenSlowDowns) return;
  slowed_at_ = now;
  share_ = std::max(kLeastShare, share_ / 2.0);
}

}  // namespace dance

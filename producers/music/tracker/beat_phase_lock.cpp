#include "producers/music/tracker/beat_phase_lock.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr double kCorrection = 0.3;  // of a difference, at each hop
// Another phase or tempo has to be so many times likelier.
constexpr double kClearly = 4.0;

}  // namespace

void BeatPhaseLock::pass(double now_s) {
  while (next_s_ <= now_s) {
    last_s_ = next_s_;
    next_s_ += period_s_;
    ++number_;
  }
}

void BeatPhaseLock::follow(const BarPointer& pointer, double heard_s, double now_s) {
  if (begun_) pass(now_s);
  const BarPointer::Place other = pointer.likeliest();
  const BarPointer::Place here = pointer.near(period_s_ / hop_s_, (next_s_ - heard_s) / hop_s_);
  if (!begun_ || here.probability * kClearly < other.probability) {
    const double old_next_s = begun_ ? next_s_ : now_s;
    const double old_period_s = period_s_;
    begun_ = true;
    period_s_ = other.period_hops * hop_s_;
    next_s_ = heard_s + other.to_beat_hops * hop_s_;
    certainty_ = other.probability;
    // A published beat is over: it is not repeated, and no other comes at once.
    while (next_s_ <= now_s || next_s_ < last_s_ + 0.5 * period_s_) next_s_ += period_s_;
    // Keeps the position in the bar: the nearest number by the old period.
    number_ +=
        std::max(std::int64_t{0},
                 static_cast<std::int64_t>(std::lround((next_s_ - old_next_s) / old_period_s)));
    return;
  }
  certainty_ = here.probability;
  if (here.probability <= 0.0) return;
  period_s_ += kCorrection * (here.period_hops * hop_s_ - period_s_);
  next_s_ += kCorrection * (heard_s + here.to_beat_hops * hop_s_ - next_s_);
  pass(now_s);
  if (next_s_ < last_s_ + 0.5 * period_s_) next_s_ = last_s_ + 0.5 * period_s_;
}

}  // namespace dance

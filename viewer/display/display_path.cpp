#include "viewer/display/display_path.h"

#include <algorithm>

namespace dance {
namespace {

// A swap that takes longer has waited for the display.
constexpr Duration kWaiting = Duration::us(400);
constexpr int kLearnAtMost = 90;
constexpr int kLearnAtLeast = 40;
// Periods are not known exactly: the phase drifts, and is looked at again.
constexpr Duration kLearnAgainAfter = Duration::s(10);
constexpr Duration kLookForWaitsAfter = Duration::s(30);
constexpr int kLateBeforeLearning = 8;
constexpr Duration kLeastMargin = Duration::us(700);
constexpr Duration kMarginStep = Duration::us(400);
constexpr double kUsualDrawing = 0.95;  // of pictures are drawn in the time set aside

}  // namespace

DisplayPath::DisplayPath(Duration nominal_period, const Options& options)
    : options_(options), nominal_(nominal_period), clock_(nominal_period) {}

void DisplayPath::start_over(Duration nominal_period, const Options& options) {
  const std::uint64_t missed = missed_;
  *this = DisplayPath(nominal_period, options);
  missed_ = missed;
}

void DisplayPath::begin_learning() {
  phase_ = Phase::kLearning;
  learnt_ = waited_ = late_in_a_row_ = 0;
  clock_.clear();
  turn_ = last_turn_ = MonoTime();
}

MonoTime DisplayPath::when_to_take(MonoTime now) {
  if (phase_ == Phase::kOwnPace) {
    if (!last_taken_.is_set()) return now;
    return std::max(now, last_taken_ + nominal_);
  }
  if (phase_ != Phase::kLatched) return now;
  turn_ = clock_.next_after(now + set_aside());
  // One picture for each turn.
  if (last_turn_.is_set() && turn_ - last_turn_ < clock_.period() / 2) turn_ += clock_.period();
  return std::max(now, turn_ - set_aside());
}

MonoTime DisplayPath::photon_time(MonoTime taken) const {
  const Duration latency = options_.latency.value_or(clock_.period() / 2);
  if (phase_ == Phase::kLatched && turn_ > taken) return turn_ + latency;
  if (!clock_.is_locked()) return taken + drawing_ + latency;
  return clock_.next_after(taken + drawing_) + latency;
}

void DisplayPath::note_drawing(Duration drawing) {
  drawings_[drawn_++ % kDrawings] = drawing;
  const std::size_t n = std::min(drawn_, kDrawings);
  std::array<Duration, kDrawings> sorted = drawings_;
  const auto at = static_cast<std::ptrdiff_t>(kUsualDrawing * static_cast<double>(n - 1));
  std::nth_element(sorted.begin(), sorted.begin() + at,
                   sorted.begin() + static_cast<std::ptrdiff_t>(n));
  drawing_ = sorted[static_cast<std::size_t>(at)];
}

void DisplayPath::on_picture(const PictureTimes& times) {
  note_drawing(times.drawn - times.taken);
  last_taken_ = times.taken;
  if (!phase_since_.is_set()) phase_since_ = times.swapped;
  if (phase_ == Phase::kLatched) judge(times);
  const bool has_waited = times.swapped - times.drawn >= kWaiting;
  if (has_waited) clock_.add(times.swapped);
  if (phase_ == Phase::kLearning) {
    ++learnt_;
    if (has_waited) ++waited_;
    learn(times);
    return;
  }
  const Duration in_phase = times.swapped - phase_since_;
  const bool again = phase_ == Phase::kOwnPace ? in_phase > kLookForWaitsAfter
                                               : in_phase > kLearnAgainAfter && !has_waited;
  if (!again && late_in_a_row_ < kLateBeforeLearning) return;
  phase_since_ = times.swapped;
  begin_learning();
}

void DisplayPath::learn(const PictureTimes& times) {
  if (clock_.is_locked() && waited_ >= kLearnAtLeast / 2) {
    phase_ = options_.is_late_latching ? Phase::kLatched : Phase::kAtOnce;
  } else if (learnt_ >= kLearnAtLeast && waited_ * 8 < learnt_) {
    phase_ = Phase::kOwnPace;  // nothing to go by
  } else if (learnt_ >= kLearnAtMost) {
    begin_learning();  // goes on without delay, as swap calls do wait
  }
  if (phase_ != Phase::kLearning) phase_since_ = times.swapped;
}

void DisplayPath::judge(const PictureTimes& times) {
  const bool is_late = times.drawn > turn_;
  last_turn_ = is_late ? clock_.next_after(times.drawn) : turn_;
  if (is_late) {
    ++missed_;
    ++late_in_a_row_;
    margin_ = std::min(margin_ + kMarginStep, clock_.period() / 2);
  } else {
    late_in_a_row_ = 0;
    // Back in some seconds.
    margin_ = std::max(kLeastMargin, margin_ - (margin_ - kLeastMargin) / 256);
  }
}

}  // namespace dance

// BeatOffset: by how many beats the stage plays behind the dancer: the whole number (or multiple of
// `count`) that keeps the dance on the listener's beat with the delay that is wished, or the least
// that prediction can bridge. It changes rarely, as each change is a jump in the dance, and then
// where the dance is most like itself so many beats later.
//
// Units/frames: beats of the listener's music. `difference` is where the listener's music stands
//               minus where the dancer's stands at the same moment; offset - difference is the
//               delay of what is shown.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/time.h"

namespace dance {

class BeatOffset {
 public:
  struct Wish {
    double beats = -1.0;       // the delay that the room wishes; negative: the least that can be
    double least_beats = 0.0;  // of delay: what is newer has not come and cannot be predicted well
    double easy_beats = 0.0;   // lowered only where what is left is no less than this
    double slack_beats = 0.0;  // below `least_beats` that is borne before it is raised
    double count = 1.0;        // offsets are multiples of it
  };

  bool is_set() const { return is_set_; }
  double value() const { return value_; }
  void reset() { is_set_ = false; }

  // Returns true where the offset has changed. `jump_m(value)`: how far joints would jump from here
  // to that offset: while the change can wait, it waits for a small jump.
  template <class Jump>
  bool update(const Wish& wish, double difference, MonoTime now, Jump jump_m) {
    const double best = best_of(wish, difference);
    if (!is_set_) {
      is_set_ = true;
      value_ = best;
      since_ = now;
      wrong_ = Wrong::kNo;
      return true;
    }
    const Wrong wrong = best == value_ ? Wrong::kNo : wrong_of(wish, difference);
    if (wrong != wrong_) since_ = now;
    wrong_ = wrong;
    const Duration hold = wrong == Wrong::kTooLow ? kRaiseAfter : lower_after_;
    if (wrong == Wrong::kNo || now - since_ < hold) return false;
    const double target = wrong == Wrong::kTooHigh && wish.beats < 0.0
                              ? above(wish, difference, wish.easy_beats)
                              : best;
    const Duration longest = wrong == Wrong::kTooLow ? kRaiseWithin : kLowerWithin;
    const Duration waited = now - since_ - hold;
    if (waited < longest) {
      const double part = waited.as_seconds() / longest.as_seconds();
      if (jump_m(target) > kUnseen_m + part * part * (kSeen_m - kUnseen_m)) return false;
    }
    if (wrong == Wrong::kTooLow) {
      // On a line that is bad every so often, or with predictions that are, the next lowering would
      // be as short.
      const bool was_short = lowered_.is_set() && now - lowered_ < kLongestHold;
      lower_after_ = was_short ? std::min(lower_after_ * 2, kLongestHold) : kLowerAfter;
    } else {
      lowered_ = now;
    }
    value_ = target;
    wrong_ = Wrong::kNo;
    return true;
  }
  bool update(const Wish& wish, double difference, MonoTime now) {
    return update(wish, difference, now, [](double) { return 0.0; });
  }

 private:
  enum class Wrong { kNo, kTooLow, kTooHigh };
  static constexpr Duration kRaiseAfter = Duration::ms(150);
  static constexpr Duration kLowerAfter = Duration::s(4);
  static constexpr Duration kLongestHold = Duration::s(60);
  // A change that is due waits so long at most for a moment when joints jump by little, and takes
  // ever larger jumps: what is shown meanwhile is predicted further than it should be, or later
  // than it need be.
  static constexpr Duration kRaiseWithin = Duration::s(1);
  static constexpr Duration kLowerWithin = Duration::s(8);
  static constexpr double kUnseen_m = 0.05, kSeen_m = 0.35;
  // A wished delay is kept as long as what is shown is no further from it than this many counts:
  // half of one would flutter, and each change is a jump in the dance. With one whole the delay
  // would not come back after a bad minute.
  static constexpr double kFlutter_counts = 0.75;

  static double above(const Wish& wish, double difference, double beats) {
    return wish.count * std::ceil((difference + beats) / wish.count - 1e-9);
  }

  static double best_of(const Wish& wish, double difference) {
    const double least = above(wish, difference, wish.least_beats);
    if (wish.beats < 0.0) return least;
    return std::max(least, wish.count * std::round((difference + wish.beats) / wish.count));
  }

  Wrong wrong_of(const Wish& wish, double difference) const {
    const double delay = value_ - difference;
    if (delay < wish.least_beats - wish.slack_beats) return Wrong::kTooLow;
    if (wish.beats < 0.0)
      return delay - wish.count > wish.easy_beats ? Wrong::kTooHigh : Wrong::kNo;
    const double most = kFlutter_counts * wish.count;
    if (delay < wish.beats - most) return Wrong::kTooLow;
    // Above the wish because the line needs it is not too high.
    const bool is_needed = delay - wish.count < wish.easy_beats;
    return delay > wish.beats + most && !is_needed ? Wrong::kTooHigh : Wrong::kNo;
  }

  double value_ = 0.0;
  bool is_set_ = false;
  Wrong wrong_ = Wrong::kNo;
  MonoTime since_;
  MonoTime lowered_;
  Duration lower_after_ = kLowerAfter;
};

}  // namespace dance

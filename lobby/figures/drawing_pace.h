// DrawingPace: decides when the lobby draws its dancers again: 30 times a second with a graphics
// card, else rarely enough to leave the processor to the page and to other programs.
//
// Units/frames: MonoTime of this process.
// Threads:      the drawing thread.
#pragma once

#include <algorithm>

#include "core/base/time.h"

namespace dance {

class DrawingPace {
 public:
  static constexpr Duration kOnCard = Duration::ms(33);
  static constexpr Duration kSoftware = Duration::ms(125);
  static constexpr Duration kLongest = Duration::ms(1000);
  // Software drawing uses at most a fifth of one core.
  static constexpr int kShare = 5;
  // Software drawing pauses after this time without mouse and keys.
  static constexpr Duration kRestsAfter = Duration::s(120);

  void set_software(bool is_software) { is_software_ = is_software; }
  bool is_software() const { return is_software_; }
  void note_input(MonoTime now) { input_ = now; }
  bool has_input() const { return input_.is_set(); }
  void note_drawn(Duration took, MonoTime now) {
    drawn_ = now;
    const Duration fair = took * kShare;
    period_ = is_software_ ? std::clamp(fair, kSoftware, kLongest) : kOnCard;
  }
  bool rests(MonoTime now) const {
    return is_software_ && input_.is_set() && now - input_ > kRestsAfter;
  }
  bool is_due(MonoTime now) const {
    return !rests(now) && (!drawn_.is_set() || now - drawn_ >= period_);
  }
  // Time until the next picture is due.
  Duration left(MonoTime now) const {
    if (rests(now)) return kLongest;
    return drawn_.is_set() ? std::max(Duration(), period_ - (now - drawn_)) : Duration();
  }

 private:
  bool is_software_ = false;
  MonoTime input_, drawn_;
  Duration period_ = kOnCard;
};

}  // namespace dance

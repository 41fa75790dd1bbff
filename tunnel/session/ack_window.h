// Which of the other side's datagrams have come: the newest number and the 32 before it, as
// acknowledgements say them, and what share is missing.
//
// Units/frames: datagram numbers are 16 bit and wrap.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      a number from nowhere is taken as newest when it is ahead; numbers that stay far
//               behind begin the window anew, so that one damaged number cannot stop it for long.
#pragma once

#include <cstdint>

#include "tunnel/session/loss_meter.h"

namespace dance {

class AckWindow {
 public:
  void note(std::uint16_t number) {
    const auto ahead = static_cast<std::int16_t>(number - newest_);
    if (span_ == 0 || (ahead <= -kSpan && ++far_behind_ >= kRestartAfter)) {
      seen_ = 1;
      span_ = 1;
      newest_ = number;
      far_behind_ = 0;
      return;
    }
    if (ahead <= -kSpan) return;
    far_behind_ = 0;
    if (ahead <= 0) {
      seen_ |= std::uint64_t{1} << -ahead;
      return;
    }
    for (int i = 0; i < ahead && i < 2 * kSpan; ++i) {
      if (span_ == kSpan)
        loss_.add((seen_ >> (kSpan - 1) & 1) == 0);
      else
        ++span_;
      seen_ <<= 1;
    }
    seen_ |= 1;
    newest_ = number;
  }

  // What was seen counts no more; the numbers go on.
  void forget() { seen_ = 0; }

  bool has(std::uint16_t number) const {
    const auto behind = static_cast<std::int16_t>(newest_ - number);
    return span_ > 0 && behind >= 0 && behind < kSpan && (seen_ >> behind & 1) != 0;
  }
  // Whether acknowledgements still speak of it.
  bool covers(std::uint16_t number) const {
    const auto behind = static_cast<std::int16_t>(newest_ - number);
    return behind >= 0 && behind < kSpan;
  }
  bool has_any() const { return span_ > 0; }
  std::uint16_t newest() const { return newest_; }
  std::uint32_t before() const { return static_cast<std::uint32_t>(seen_ >> 1); }
  const LossMeter& loss() const { return loss_; }

 private:
  static constexpr int kSpan = 33;
  static constexpr int kRestartAfter = 8;

  std::uint16_t newest_ = 0;
  std::uint64_t seen_ = 0;  // bit i: newest − i came; only the low 33 are looked at
  int span_ = 0;            // how many numbers the window has covered
  int far_behind_ = 0;
  LossMeter loss_;
};

}  // namespace dance

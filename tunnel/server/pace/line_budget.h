// How many bytes a second a receiver's line bears. Not limited until the line says otherwise: by
// round trips that have grown, which is a queue before a line that is too narrow, or by losses of
// many. Then less than what went out, and from there a little more each second, until there is
// room for all again: additive increase, multiplicative decrease.
//
// Some loss alone is no reason: on Wi-Fi it does not go away with fewer bytes. Nor is much loss of
// what half a megabit bears.
//
// Units/frames: bytes a second, with the headers of IP and UDP; losses are shares of datagrams.
// Ownership:    plain value.
// Threads:      none inside; one owner.
// Failure:      a round trip of 0 is not known yet, and tells nothing.
// Source:       Chiu, Jain: Analysis of the increase and decrease algorithms for congestion
//               avoidance, 1989. The bounds of losses are those of Google Congestion Control
//               (draft-ietf-rmcat-gcc-02, section 6).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "core/base/time.h"

namespace dance {

class LineBudget {
 public:
  static constexpr double kLeast = 4e3;
  static constexpr double kLeastForLoss = 64e3;
  static constexpr double kMore = 2e3;           // each second
  static constexpr double kLess = 0.7;           // times what went out,
  static constexpr double kLessOfArrived = 0.9;  // or what arrived

  // Of the time since the last report.
  struct Report {
    double bytes_per_s = 0.0;
    double loss = 0.0;
    Duration round_trip;
  };

  bool is_limited() const { return budget_ < kUnlimited; }
  // Infinite where it is not limited.
  double bytes_per_second() const { return budget_; }

  // `all`: what goes out where nothing is held back.
  void update(const Report& report, double all, MonoTime now) {
    note(report.round_trip, now);
    const Duration queue = recent() - least();
    const Duration bound = std::max(kQueue, least() / 4);
    const Duration passed = updated_.is_set() ? now - updated_ : Duration();
    updated_ = now;
    if (queue > bound || report.loss > kMuchLoss) {
      const double least = std::min(budget_, queue > bound ? kLeast : kLeastForLoss);
      // What arrived was not too much: with less than that the queue becomes shorter.
      const double arrived =
          report.bytes_per_s * std::min(kLess, kLessOfArrived * (1.0 - report.loss));
      const double less = std::max(least, std::min(kLess * budget_, arrived));
      const bool is_early = lowered_.is_set() && now - lowered_ < kTakesEffect + recent();
      if (is_early || less > kRoomForAll * all) return;
      lowered_ = now;
      budget_ = less;
      return;
    }
    if (!is_limited() || queue > bound / 2 || report.loss > kLittleLoss) return;
    budget_ += kMore * passed.as_seconds();
    if (budget_ > kRoomForAll * all) budget_ = kUnlimited;
  }

 private:
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  static constexpr double kMuchLoss = 0.10, kLittleLoss = 0.02;
  static constexpr double kRoomForAll = 1.25;
  // More than what a busy machine or Wi-Fi make of it three times in a row.
  static constexpr Duration kQueue = Duration::ms(30);
  // Until the queue is gone, and the last three round trips tell so.
  static constexpr Duration kTakesEffect = Duration::ms(1200);
  static constexpr Duration kRemembers = Duration::s(15);  // once or twice that

  void note(Duration round_trip, MonoTime now) {
    if (round_trip <= Duration()) return;
    if (seen_ == 0) recent_.fill(round_trip);
    recent_[seen_++ % recent_.size()] = round_trip;
    // Another path may be longer for good: the least round trip is forgotten in time.
    if (!least_since_.is_set() || now - least_since_ > kRemembers) {
      least_before_ = least_since_.is_set() ? least_now_ : round_trip;
      least_now_ = round_trip;
      least_since_ = now;
    }
    least_now_ = std::min(least_now_, round_trip);
  }
  // A queue is in each of them, a late turn of some machine is not.
  Duration recent() const { return *std::min_element(recent_.begin(), recent_.end()); }
  Duration least() const { return std::min(least_now_, least_before_); }

  double budget_ = kUnlimited;
  MonoTime updated_, lowered_, least_since_;
  Duration least_now_, least_before_;
  std::array<Duration, 3> recent_{};
  std::size_t seen_ = 0;
};

}  // namespace dance

// TapDelay: the delay of a loudspeaker that the sound server does not know, from taps along with a
// steady click: the median of how late the taps are. A person who taps evenly is found again at any
// delay of less than a click's period; taps that scatter are refused.
//
// Units/frames: seconds since click 0, as the sound server says that it is heard.
// Ownership:    plain value, no heap.
// Failure:      result() says how many taps are missing, or that they scatter.
#pragma once

#include <array>
#include <cstddef>

namespace dance {

class TapDelay {
 public:
  static constexpr double kPeriod_s = 0.8;        // of the click
  static constexpr double kLeast_s = -0.2;        // a delay is in this period
  static constexpr std::size_t kTaps = 11;        // that are judged
  static constexpr std::size_t kFirst = 2;        // until one taps in time: not judged
  static constexpr double kMostSpread_s = 0.040;  // standard deviation, by the median deviation

  enum class State { kNeedsMore, kScattered, kFound };
  struct Result {
    State state = State::kNeedsMore;
    std::size_t missing = kTaps;
    double delay_s = 0.0;   // where found
    double spread_s = 0.0;  // where all taps are there
  };

  // A key that bounces is one tap; a time that is no number is none. All after the last one needed
  // change nothing.
  void tap(double at_s);
  Result result() const;

 private:
  std::array<double, kTaps> late_s_{};  // within one period
  std::size_t count_ = 0;               // with the first ones
  double last_s_ = -1e9;
};

}  // namespace dance

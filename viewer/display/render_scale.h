// RenderScale: draws the stage with fewer pixels while this machine is too slow for all of them,
// and with more again when there is time. A picture's time falls with the number of its pixels, so
// a larger scale is tried only if the present time shows that it fits.
//
// Units/frames: share of the window's width and height; MonoTime of this process.
// Threads:      the drawing thread.
#pragma once

#include <array>
#include <cstddef>

#include "core/base/time.h"

namespace dance {

class RenderScale {
 public:
  static constexpr std::array kScales{1.0f, 0.8f, 0.65f, 0.5f};
  // The scale falls above this mean time of a picture, and may rise below kGood.
  static constexpr Duration kTooSlow = Duration::ms(45);
  static constexpr Duration kGood = Duration::ms(30);
  static constexpr Duration kFallsAfter = Duration::ms(600);
  // Doubled each time that a larger scale proves too slow, up to kLongestWait.
  static constexpr Duration kRisesAfter = Duration::s(4);
  static constexpr Duration kLongestWait = Duration::s(64);

  // After each picture: the time that it took to draw.
  void on_picture(Duration drawing, MonoTime now);
  float scale() const { return kScales[step_]; }
  bool is_smallest() const { return step_ + 1 == kScales.size(); }

 private:
  void change(std::size_t step, MonoTime now);

  std::size_t step_ = 0;
  Duration mean_;
  MonoTime changed_;     // when the scale changed; not set: before the first picture
  MonoTime slow_since_;  // not set: the mean is not too slow
  MonoTime good_since_;  // not set: a larger scale would be too slow
  Duration rises_after_ = kRisesAfter;
  bool has_risen_ = false;  // the last change was to more pixels
};

}  // namespace dance

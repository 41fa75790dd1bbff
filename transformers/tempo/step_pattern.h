// StepPattern: what the steps of a dance look like over eight counts of the music: how fast each
// foot goes, how the hips sway, which foot is higher, how the hips bounce. Left and right are
// mirrored: a dancer who begins with the other foot is four counts on, so one pattern serves both
// partners of a couple.
//
// Units/frames: phases are parts of eight counts, 0 .. 1; counts that are stepped on are whole
//               eighths but the last of each four, in which the feet rest. Signs are without their
//               mean, at about the size 1 (see StepSigns).
// Ownership:    plain values.
// Threads:      none inside; const use from any.
// Failure:      none.
#pragma once

#include <array>
#include <complex>
#include <cstddef>

namespace dance {

struct StepPattern {
  static constexpr double kCounts = 8.0;
  static constexpr std::size_t kHarmonics = 12;  // of eight counts
  enum Sign : std::size_t { kLeftFoot, kRightFoot, kSway, kHigherFoot, kBounce };
  static constexpr std::size_t kSigns = 5;
  using Wave = std::array<std::complex<float>, kHarmonics>;

  std::array<Wave, kSigns> wave{};
  std::array<float, kSigns> spread{};  // variance of what the wave leaves
  std::array<float, kSigns> power{};   // variance of the sign altogether

  // sum of Re w_h e^(j 2 pi h phase), h = 1 .. kHarmonics
  float value(std::size_t sign, double phase) const;
  // Makes left and right mirror each other: half of the sum of each sign and its mirror image.
  void mirror();
  // The same steps, so many counts earlier.
  void bring_forward(double counts);
};

// Of salsa, learnt from fourteen dances of seven couples.
const StepPattern& salsa_steps();

}  // namespace dance

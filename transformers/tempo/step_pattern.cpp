#include "transformers/tempo/step_pattern.h"

#include <cmath>
#include <numbers>

namespace dance {
namespace {

using Wave = StepPattern::Wave;

// Real and imaginary parts by turns, as `dance rhythm eval --learn-steps` prints them; the right
// foot's is the left one's, half of the eight counts on.
using Parts = std::array<float, 2 * StepPattern::kHarmonics>;
constexpr Parts kFoot{-0.423f, 0.130f,  -0.109f, -0.034f, 0.296f,  -0.888f, 0.021f,  0.238f,
                      -0.109f, -0.076f, -0.044f, -0.077f, -0.003f, -0.013f, -0.003f, 0.011f,
                      0.008f,  0.001f,  -0.012f, 0.0f,    0.007f,  -0.005f, 0.006f,  -0.005f};
constexpr Parts kSway{0.031f,  0.195f,  0.0f, 0.0f, -1.061f, -0.017f, 0.0f, 0.0f,
                      -0.016f, 0.122f,  0.0f, 0.0f, -0.099f, 0.036f,  0.0f, 0.0f,
                      -0.038f, -0.026f, 0.0f, 0.0f, -0.015f, 0.015f,  0.0f, 0.0f};
constexpr Parts kHigherFoot{-0.665f, 0.069f,  0.0f, 0.0f, 0.290f,  -0.802f, 0.0f, 0.0f,
                            -0.074f, -0.123f, 0.0f, 0.0f, -0.006f, 0.020f,  0.0f, 0.0f,
                            -0.002f, -0.012f, 0.0f, 0.0f, 0.0f,    0.0f,    0.0f, 0.0f};
constexpr Parts kBounce{0.0f, 0.0f, -0.310f, -0.367f, 0.0f, 0.0f, 0.273f,  0.388f,
                        0.0f, 0.0f, -0.014f, 0.272f,  0.0f, 0.0f, 0.047f,  0.093f,
                        0.0f, 0.0f, -0.025f, -0.032f, 0.0f, 0.0f, -0.003f, 0.027f};
constexpr std::array<float, StepPattern::kSigns> kSpread{0.538f, 0.538f, 0.676f, 0.650f, 0.902f};
constexpr std::array<float, StepPattern::kSigns> kPower{1.121f, 1.121f, 1.273f, 1.248f, 1.174f};

constexpr Wave wave_of(const Parts& parts, float odd = 1.0f) {
  Wave wave;
  for (std::size_t h = 0; h < StepPattern::kHarmonics; ++h) {
    const float sign = h % 2 == 0 ? odd : 1.0f;
    wave[h] = {sign * parts[2 * h], sign * parts[2 * h + 1]};
  }
  return wave;
}

constexpr StepPattern kSalsa{.wave = {wave_of(kFoot), wave_of(kFoot, -1.0f), wave_of(kSway),
                                      wave_of(kHigherFoot), wave_of(kBounce)},
                             .spread = kSpread,
                             .power = kPower};

}  // namespace

float StepPattern::value(std::size_t sign, double phase) const {
  double sum = 0.0;
  for (std::size_t h = 0; h < kHarmonics; ++h) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(h + 1) * phase;
    sum += static_cast<double>(wave[sign][h].real()) * std::cos(angle) -
           static_cast<double>(wave[sign][h].imag()) * std::sin(angle);
  }
  return static_cast<float>(sum);
}

void StepPattern::mirror() {
  for (std::size_t h = 0; h < kHarmonics; ++h) {
    // Half a turn of the eight counts turns odd harmonics by half a turn.
    const float half = h % 2 == 0 ? -1.0f : 1.0f;
    const std::complex<float> left = wave[kLeftFoot][h], right = wave[kRightFoot][h];
    wave[kLeftFoot][h] = 0.5f * (left + half * right);
    wave[kRightFoot][h] = half * wave[kLeftFoot][h];
    // The hips go to the other side, the other foot is the higher one; the bounce is the same.
    if (half > 0.0f)
      wave[kSway][h] = wave[kHigherFoot][h] = 0.0f;
    else
      wave[kBounce][h] = 0.0f;
  }
}

void StepPattern::bring_forward(double counts) {
  for (Wave& of_sign : wave)
    for (std::size_t h = 0; h < kHarmonics; ++h)
      of_sign[h] *= std::complex<float>(
          std::polar(1.0, 2.0 * std::numbers::pi * static_cast<double>(h + 1) * counts / kCounts));
}

const StepPattern& salsa_steps() { return kSalsa; }

}  // namespace dance

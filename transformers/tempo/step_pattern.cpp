#include "transformers/tempo/step_pattern.h"

#include <cmath>
#include <numbers>

namespace dance {
namespace {

using Wave = StepPattern::Wave;

// As `dance rhythm eval --learn-steps` prints it.
constexpr StepPattern made_of(const Wave& foot, const Wave& sway, const Wave& higher,
                              const Wave& bounce,
                              const std::array<float, StepPattern::kSigns>& spread,
                              const std::array<float, StepPattern::kSigns>& power) {
  StepPattern pattern;
  pattern.wave = {foot, foot, sway, higher, bounce};
  pattern.spread = spread;
  pattern.power = power;
  for (std::size_t h = 0; h < StepPattern::kHarmonics; h += 2)
    pattern.wave[StepPattern::kRightFoot][h] = -pattern.wave[StepPattern::kRightFoot][h];
  return pattern;
}

const StepPattern kSalsa =
    made_of({{{-0.373f, 0.164f},
              {-0.115f, -0.014f},
              {0.156f, -0.964f},
              {0.073f, 0.241f},
              {-0.142f, -0.040f},
              {-0.104f, -0.086f},
              {0.015f, -0.014f},
              {-0.006f, 0.018f},
              {0.015f, -0.005f},
              {-0.008f, 0.019f},
              {-0.010f, -0.015f},
              {-0.010f, -0.004f}}},
            {{{0.047f, 0.128f},
              {0.0f, 0.0f},
              {-1.056f, 0.120f},
              {0.0f, 0.0f},
              {0.020f, 0.130f},
              {0.0f, 0.0f},
              {-0.068f, 0.078f},
              {0.0f, 0.0f},
              {-0.078f, -0.013f},
              {0.0f, 0.0f},
              {-0.008f, 0.046f},
              {0.0f, 0.0f}}},
            {{{-0.614f, 0.110f},
              {0.0f, 0.0f},
              {0.239f, -0.880f},
              {0.0f, 0.0f},
              {-0.106f, -0.124f},
              {0.0f, 0.0f},
              {0.0f, 0.022f},
              {0.0f, 0.0f},
              {0.001f, -0.015f},
              {0.0f, 0.0f},
              {-0.010f, 0.006f},
              {0.0f, 0.0f}}},
            {{{0.0f, 0.0f},
              {-0.346f, -0.370f},
              {0.0f, 0.0f},
              {0.304f, 0.358f},
              {0.0f, 0.0f},
              {0.062f, 0.276f},
              {0.0f, 0.0f},
              {0.088f, 0.077f},
              {0.0f, 0.0f},
              {-0.034f, -0.021f},
              {0.0f, 0.0f},
              {0.014f, 0.022f}}},
            {0.449f, 0.449f, 0.644f, 0.535f, 0.829f}, {1.068f, 1.068f, 1.236f, 1.159f, 1.116f});

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

const StepPattern& salsa_steps() { return kSalsa; }

}  // namespace dance

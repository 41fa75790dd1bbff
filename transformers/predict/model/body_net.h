// BodyNet: what many dancers have in common, as a small trained network: from the last half second
// of all bones to where they will be at eight horizons. It answers as 96 numbers, which a basis
// turns into the bones' ways.
//
// Units/frames: rows as transformers/predict/model/body_row.h, 60 a second; ways are differences of
//               rows in the dancer's heading, at kHorizonFrames from now.
// Ownership:    the network is large and shared, read-only; inputs and answers are the caller's.
// Threads:      const use from any.
// Failure:      none: inputs are bounded, so that answers are.
// Source:       Guo et al., Back to MLP: A Simple Baseline for Human Motion Prediction, WACV 2023,
//               for how little is enough; the form is our own.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/base/cache_aligned.h"
#include "transformers/predict/model/body_row.h"

namespace dance {

constexpr std::size_t kHorizons = 8;
constexpr std::array<int, kHorizons> kHorizonFrames{3, 6, 9, 12, 18, 24, 36, 60};
constexpr double kGridHz = 60.0;
using BodyWays = std::array<BodyRow, kHorizons>;

constexpr std::array<std::size_t, 7> kNetLags{1, 2, 4, 7, 12, 20, 32};
constexpr std::size_t kNetHistory = 33;  // rows, the newest among them
constexpr std::size_t kBoneNumbers = 3 * kBoneCount;
// Bones and height as they are, all of it against kNetLags before, what the sensor trembles by, and
// 1.
constexpr std::size_t kNetInputs = 560;
constexpr std::size_t kNetHidden = 192;
constexpr std::size_t kNetAnswers = 96;
constexpr float kMostInput = 8.0f;  // standard deviations

using NetInputs = std::array<float, kNetInputs>;
using NetAnswers = std::array<float, kNetAnswers>;

struct BodyNet {
  using Numbers = std::vector<float, CacheAligned<float>>;
  Numbers mean, scale;          // kNetInputs
  Numbers straight;             // inputs x answers
  Numbers first, first_bias;    // inputs x hidden
  Numbers second, second_bias;  // hidden x hidden
  Numbers third, third_bias;    // hidden x answers
  Numbers basis;                // answers x (horizons x row)

  static BodyNet blank();
  // Visits each block of numbers, in the order of the file.
  template <class Self, class Visit>
  static void visit(Self& net, Visit visit) {
    for (auto* block : {&net.mean, &net.scale, &net.straight, &net.first, &net.first_bias,
                        &net.second, &net.second_bias, &net.third, &net.third_bias, &net.basis})
      visit(*block);
  }

  // Inputs as they are, and made comparable with mean and scale.
  void normalise(NetInputs& inputs) const;
  void answer(const NetInputs& inputs, NetAnswers& answers) const;
  // Of one answer, and of two at once for little more than one.
  void ways_of(const NetAnswers& answers, BodyWays& ways) const;
  void ways_of(const NetAnswers& a, BodyWays& ways_a, const NetAnswers& b, BodyWays& ways_b) const;
};

// `row(l)`: the row of l frames ago, l < kNetHistory. `tremble_rad`: what the sensor trembles by.
template <class Rows>
void net_inputs(const Rows& rows, float tremble_rad, NetInputs& inputs) {
  const BodyRow& now = rows(0);
  std::size_t n = 0;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    for (std::size_t axis = 0; axis < 3; ++axis) inputs[n++] = now(b, axis);
  inputs[n++] = now(kPlaceGroup, 1);
  const float sine = -std::sin(now.heading()), cosine = std::cos(now.heading());
  for (const std::size_t lag : kNetLags) {
    BodyRow way;
    const BodyRow& then = rows(lag);
    for (std::size_t i = 0; i < kRowSize; ++i) way.v[i] = now.v[i] - then.v[i];
    turn_place(way, sine, cosine);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t g = 0; g < kHeadingGroup; ++g) inputs[n++] = way(g, axis);
    inputs[n++] = way.heading();
  }
  inputs[n++] = tremble_rad;
  while (n < kNetInputs) inputs[n++] = 0.0f;
}

}  // namespace dance

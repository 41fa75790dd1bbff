// What a partner's hands tell of a dancer's palm: eight guesses of where the palm will be, each
// with a weight that depends on how the two palms have been to each other.
//
// Units/frames: a guess is its difference to the plain prediction, metres in W; signs are numbers
//               around 0.
// Ownership:    plain values.
// Threads:      constants only.
// Failure:      none.
// Source:       `dance predict eval --partner --fit-palms`, as docs/prediction.md has it: three
//               salsas, predicted by a model that had not seen them. The two that the page judges
//               had no part in it.
#pragma once

#include <array>
#include <cstddef>

namespace dance {

enum class PalmGuess : std::size_t {
  kOffset,     // as far from the partner's palm as it was, turned with the line between the dancers
  kInHand,     // the same, turned with the partner's hand
  kTurned,     // turned about the own hips as the partner turns
  kMissed,     // predictions go on missing as they last did
  kHips,       // moved as hips that keep their place to the partner's, turned with the line
  kAlong,      // moved as hips that go the way of the partner's
  kOnForearm,  // as far from the partner's palm as it was, turned with the own forearm
  kAway,       // further from the partner's palm by as much as it was away
  kCount,
};
enum class PalmSign : std::size_t {
  kOne,
  kApart,      // how far apart palms are
  kDrift,      // how fast the offset has changed
  kDisagree,   // how far the offset's guess is from the prediction
  kProved,     // whether the offset or the prediction was lately right
  kAhead,      // how far ahead
  kProvedNow,  // as kProved, over a tenth of a second
  kCount,
};
constexpr auto kPalmGuesses = static_cast<std::size_t>(PalmGuess::kCount);
constexpr auto kPalmSigns = static_cast<std::size_t>(PalmSign::kCount);

using PalmWeights = std::array<std::array<float, kPalmSigns>, kPalmGuesses>;

constexpr PalmWeights kPalmWeights{{
    {{0.330f, -0.021f, -0.220f, -0.231f, 0.102f, 0.123f, 0.184f}},
    {{0.137f, -0.095f, 0.024f, -0.191f, 0.031f, 0.045f, 0.016f}},
    {{0.085f, -0.082f, 0.000f, 0.000f, 0.022f, 0.030f, -0.015f}},
    {{0.149f, 0.024f, 0.000f, 0.000f, 0.029f, -0.150f, -0.161f}},
    {{-0.062f, 0.084f, 0.000f, 0.000f, -0.274f, 0.017f, 0.154f}},
    {{0.023f, 0.026f, 0.000f, 0.000f, -0.108f, 0.007f, 0.047f}},
    {{0.095f, -0.055f, 0.000f, 0.000f, -0.038f, 0.017f, 0.086f}},
    {{-0.016f, -0.010f, 0.000f, 0.000f, 0.012f, -0.013f, -0.022f}},
}};

}  // namespace dance

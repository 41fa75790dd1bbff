// What a partner's hands tell of a dancer's palm: eight guesses of where the palm will be, each
// with a weight that depends on how the two palms have been to each other.
//
// Units/frames: a guess is its difference to the plain prediction, metres in W; signs are numbers
//               around 0.
// Threads:      constants only.
// Failure:      none.
// Source:       least mean errors of palms 60 to 300 ms ahead in five salsas, predicted by models
//               that had not seen them. The two that docs/prediction.md judges had no part in it.
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
    {{0.299f, 0.001f, -0.067f, -0.243f, 0.121f, 0.105f, 0.193f}},
    {{0.139f, -0.094f, -0.016f, -0.160f, -0.016f, 0.054f, 0.045f}},
    {{0.084f, -0.074f, 0.000f, 0.000f, 0.031f, 0.034f, -0.004f}},
    {{0.120f, 0.016f, 0.000f, 0.000f, 0.038f, -0.150f, -0.123f}},
    {{-0.067f, 0.012f, 0.000f, 0.000f, -0.139f, -0.008f, 0.074f}},
    {{0.005f, 0.047f, 0.000f, 0.000f, -0.107f, 0.013f, 0.029f}},
    {{0.092f, -0.043f, 0.000f, 0.000f, -0.071f, 0.004f, 0.151f}},
    {{-0.012f, -0.015f, 0.000f, 0.000f, 0.012f, -0.007f, -0.028f}},
}};

}  // namespace dance

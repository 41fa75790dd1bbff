// GuessBlend: how much each guess is worth for this dancer, joint by joint and horizon by horizon:
// a ridge regression that begins with the model's weights and follows how past moments went on.
// Moments count less the more their guess was off, so that the mean error becomes small, not that
// of squares.
//
// Units/frames: guesses and ways as transformers/predict/moment_guesses.h.
// Ownership:    its own sums; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      none: guesses that are as good as nothing keep the model's weight.
#pragma once

#include <array>
#include <memory>

#include "transformers/predict/moment_guesses.h"
#include "transformers/predict/predict_model.h"

namespace dance {

class GuessBlend {
 public:
  GuessBlend();
  void clear();

  // What the weights begin with, and are drawn to.
  void set_prior(const KindWeights& prior);
  // A moment that is over: it went `way` after kHorizonFrames[horizon].
  void learn(std::size_t horizon, const MomentGuesses& guesses, const BodyRow& way);
  // Takes what was learned into the weights of one horizon.
  void solve(std::size_t horizon);
  void blend(std::size_t horizon, const MomentGuesses& guesses, BodyRow& way) const;

 private:
  static constexpr std::size_t kPairs = kGuesses * (kGuesses + 1) / 2;
  struct Horizon {
    alignas(64) std::array<float, kPairs * kRowGroups> pairs{};
    alignas(64) std::array<float, kGuesses * kRowGroups> targets{};
    alignas(64) std::array<float, kGuesses * kRowGroups> prior{};
    alignas(64) std::array<float, kGuesses * kRowGroups> weights{};
    std::array<float, kRowGroups> usual_error{};
    float heard = 0.0f;
  };
  std::unique_ptr<std::array<Horizon, kHorizons>> horizons_;
};

}  // namespace dance

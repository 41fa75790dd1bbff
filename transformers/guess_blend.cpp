#include "transformers/guess_blend.h"

#include "transformers/row_kernels.h"

namespace dance {
namespace {

// A half-life of 14 s at 30 moments a second.
constexpr float kKeep = 0.99835f;
// How much the prior counts against what was heard, by horizon; and beside it while little was heard.
constexpr std::array<float, kHorizons> kRidge{0.01f, 0.01f, 0.015f, 0.02f,
                                              0.03f, 0.05f, 0.1f,   0.3f};
constexpr float kFirstMoments = 30.0f;

}  // namespace

GuessBlend::GuessBlend() : horizons_(std::make_unique<std::array<Horizon, kHorizons>>()) {}

void GuessBlend::clear() {
  for (Horizon& horizon : *horizons_) {
    horizon.pairs.fill(0.0f);
    horizon.targets.fill(0.0f);
    horizon.weights = horizon.prior;
    horizon.heard = 0.0f;
  }
}

void GuessBlend::set_prior(const KindWeights& prior) {
  for (std::size_t h = 0; h < kHorizons; ++h) {
    Horizon& horizon = (*horizons_)[h];
    for (std::size_t e = 0; e < kGuesses; ++e)
      for (std::size_t g = 0; g < kRowGroups; ++g)
        horizon.prior[e * kRowGroups + g] = prior[kKindOfGroup[g]][h][e];
    if (horizon.heard == 0.0f) horizon.weights = horizon.prior;
  }
}

void GuessBlend::learn(std::size_t h, const MomentGuesses& guesses, const BodyRow& way) {
  Horizon& horizon = (*horizons_)[h];
  std::array<const float*, kGuesses> rows;
  for (std::size_t e = 0; e < kGuesses; ++e) rows[e] = guesses.row(h, e);
  follow_gram(rows.data(), kGuesses, way.v.data(), kKeep, horizon.pairs.data(),
              horizon.targets.data());
  horizon.heard = kKeep * horizon.heard + 1.0f;
}

void GuessBlend::solve(std::size_t h) {
  Horizon& horizon = (*horizons_)[h];
  if (horizon.heard < kFirstMoments) return;
  solve_groups(horizon.pairs.data(), horizon.targets.data(), kGuesses,
               kRidge[h] * (1.0f + 10.0f * kFirstMoments / horizon.heard), horizon.prior.data(),
               horizon.weights.data());
}

void GuessBlend::blend(std::size_t h, const MomentGuesses& guesses, BodyRow& way) const {
  const Horizon& horizon = (*horizons_)[h];
  way.v.fill(0.0f);
  for (std::size_t e = 0; e < kGuesses; ++e) {
    const float* row = guesses.row(h, e);
    const float* weights = &horizon.weights[e * kRowGroups];
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t g = 0; g < kRowGroups; ++g)
        way.v[axis * kRowGroups + g] += weights[g] * row[axis * kRowGroups + g];
  }
}

}  // namespace dance

#include "transformers/predict/blend/prediction_proof.h"

#include <algorithm>

#include "transformers/predict/model/row_kernels.h"

namespace dance {
namespace {

// 30 moments a second: a half-life of 15 s.
constexpr float kShareKeep = 0.99846f;
// What a correction must have proved before it counts, as a part of what it would prove in the
// half-life.
constexpr float kCaution = 0.05f;
// As much as is right of the corrections of a dancer who was seen for some minutes.
constexpr float kShareOfAcquainted = 0.33f;

}  // namespace

void PredictionProof::clear() { horizons_ = {}; }

void PredictionProof::discount_personal() {
  for (Horizon& horizon : horizons_)
    for (std::size_t g = 0; g < kRowGroups; ++g) horizon.right[g] *= 0.9f, horizon.size[g] *= 0.9f;
}

void PredictionProof::add_personal(std::size_t h, const MomentPredictions& predictions,
                                   BodyRow& way) const {
  for (std::size_t i = 0; i < kRowSize; ++i)
    way.v[i] += horizons_[h].share[i % kRowGroups] * predictions.personal[h].v[i];
}

float PredictionProof::proved(std::size_t h, std::uint32_t presence) const {
  float sum = 0.0f, seen = 0.0f;
  for (std::size_t bone = 1; bone < kBoneCount; ++bone) {
    if ((presence >> bone & 1u) == 0) continue;
    sum += horizons_[h].share[bone];
    seen += 1.0f;
  }
  return seen > 0.0f ? std::min(1.0f, sum / (kShareOfAcquainted * seen)) : 0.0f;
}

DANCE_WIDE_VECTORS void PredictionProof::learn(std::size_t h, const MomentPredictions& predictions,
                                               const BodyRow& way) {
  Horizon& horizon = horizons_[h];
  const BodyRow& p = predictions.impersonal[h];
  const BodyRow& c = predictions.personal[h];
  for (std::size_t g = 0; g < kRowGroups; ++g) {
    float right = 0.0f, size = 0.0f;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t i = BodyRow::at(g, axis);
      right += (way.v[i] - p.v[i]) * c.v[i];
      size += c.v[i] * c.v[i];
    }
    horizon.right[g] = kShareKeep * horizon.right[g] + right;
    horizon.size[g] = kShareKeep * horizon.size[g] + size;
    // A part is held against it until there is as much for it.
    const float held = kCaution * size / (1.0f - kShareKeep);
    horizon.share[g] = std::clamp(horizon.right[g] / (horizon.size[g] + held + 1e-9f), 0.0f, 1.0f);
  }
}

}  // namespace dance

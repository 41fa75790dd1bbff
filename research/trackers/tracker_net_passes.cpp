#include "research/trackers/tracker_net_passes.h"

#include <algorithm>
#include <cmath>

#include "research/matrix_product.h"

namespace dance {
namespace {

constexpr std::size_t kFirstJudgedStep = 16, kChunk = 128;
constexpr float kDropUnits = 0.2f;
constexpr std::size_t kRow = kTrackerHalf * kTrackerUnits;

// What each bone's rotation counts: the ones that carry much of the body more.
constexpr std::array<float, kBoneCount> kBoneWeights{2.0f, 1.0f, 1.0f, 1.5f, 0.5f, 0.0f, 0.7f, 1.2f,
                                                     1.0f, 0.4f, 0.7f, 1.2f, 1.0f, 0.4f, 1.5f, 1.2f,
                                                     0.6f, 0.2f, 1.5f, 1.2f, 0.6f, 0.2f};
constexpr float kPlaceWeight = 4.0f, kStandsWeight = 0.4f;
constexpr float kTurnFloor = 0.05f, kPlaceFloor = 0.02f;
constexpr float kPace = 1.0f, kPaceFloor = 0.01f;  // of the change from step to step

float some_sigmoid(float x) { return 1.0f / (1.0f + std::exp(-x)); }

// to += from' of rows x columns.
void turn_matrix(const float* from, std::size_t rows, std::size_t columns, TrackerFloats& to) {
  to.resize(rows * columns);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) to[j * rows + i] = from[i * columns + j];
}

// c += a' b over many rows, a piece at a time so that it stays in the cache.
void add_outer(const float* a, std::size_t a_wide, const float* b, std::size_t b_wide, float* c,
               std::size_t rows) {
  for (std::size_t k = 0; k < rows; k += kChunk)
    add_matrix_product(a + k * a_wide, 1, a_wide, b + k * b_wide, b_wide, c, a_wide,
                       std::min(kChunk, rows - k), b_wide);
}

}  // namespace

TrackerPasses::TrackerPasses(const TrackerParameters& places)
    : inputs(kTrackerRows * kTrackerWideInputs),
      targets(kTrackerRows * kTrackerWideOutputs),
      gradient(places.count),
      places_(places),
      outputs_(kTrackerRows * kTrackerWideOutputs),
      errors_(outputs_.size()),
      carried_(kRow),
      carried_next_(kRow) {
  for (Kept& kept : kept_) {
    for (TrackerFloats* of :
         {&kept.z, &kept.r, &kept.n, &kept.again_n, &kept.h, &kept.shown, &kept.errors})
      of->resize(kTrackerRows * kTrackerUnits);
    kept.mask.resize(kRow);
    kept.gates.resize(kTrackerRows * kTrackerGates);
    kept.again_gates.resize(kTrackerRows * kTrackerGates);
  }
}

void TrackerPasses::run(const TrackerFloats& p, Random& random) {
  std::fill(gradient.begin(), gradient.end(), 0.0f);
  for (Kept& kept : kept_)
    for (float& m : kept.mask)
      m = static_cast<float>(random.uniform()) < kDropUnits ? 0.0f : 1.0f / (1.0f - kDropUnits);
  for (std::size_t l = 0; l < kept_.size(); ++l) forward(p, l);
  judge(p);
  backward_out(p);
  for (std::size_t l = kept_.size(); l-- > 0;) backward(p, l);
}

void TrackerPasses::forward(const TrackerFloats& p, std::size_t l) {
  Kept& kept = kept_[l];
  const TrackerParameters::Layer& at = places_.layers[l];
  const std::size_t inner = TrackerParameters::inputs(l);
  for (std::size_t i = 0; i < kTrackerRows; ++i) {
    std::copy_n(&p[at.in_bias], kTrackerGates, &kept.gates[i * kTrackerGates]);
    std::copy_n(&p[at.again_bias], kTrackerGates, &kept.again_gates[i * kTrackerGates]);
  }
  add_matrix_product(below(l), inner, 1, &p[at.in], kTrackerGates, kept.gates.data(), kTrackerRows,
                     inner, kTrackerGates);
  for (std::size_t t = 0; t < kTrackerSteps; ++t) {
    const std::size_t row = t * kRow;
    float* in = &kept.gates[t * kTrackerHalf * kTrackerGates];
    float* again = &kept.again_gates[t * kTrackerHalf * kTrackerGates];
    if (t > 0)
      add_matrix_product(&kept.h[row - kRow], kTrackerUnits, 1, &p[at.again], kTrackerGates, again,
                         kTrackerHalf, kTrackerUnits, kTrackerGates);
    for (std::size_t b = 0; b < kTrackerHalf; ++b)
      for (std::size_t u = 0; u < kTrackerUnits; ++u) {
        const std::size_t g = b * kTrackerGates + u, k = b * kTrackerUnits + u, i = row + k;
        const float z = some_sigmoid(in[g] + again[g]);
        const float r = some_sigmoid(in[g + kTrackerUnits] + again[g + kTrackerUnits]);
        const float n = std::tanh(in[g + 2 * kTrackerUnits] + r * again[g + 2 * kTrackerUnits]);
        const float before = t > 0 ? kept.h[i - kRow] : 0.0f;
        kept.z[i] = z;
        kept.r[i] = r;
        kept.n[i] = n;
        kept.again_n[i] = again[g + 2 * kTrackerUnits];
        kept.h[i] = (1.0f - z) * n + z * before;
        kept.shown[i] = kept.h[i] * kept.mask[k];
      }
  }
}

// The loss of a group of numbers e: w (√(|e|² + f²) − f), and the same of its change from step to
// step.
void TrackerPasses::judge_group(std::size_t from, std::size_t count, float weight, float floor,
                                float pace) {
  constexpr std::size_t kStepWide = kTrackerHalf * kTrackerWideOutputs;
  const auto add = [&](std::size_t i, bool is_change, float w, float f) {
    float square = f * f;
    std::array<float, 6> e{};
    for (std::size_t j = 0; j < count; ++j) {
      e[j] = outputs_[i + j] - targets[i + j];
      if (is_change) e[j] -= outputs_[i + j - kStepWide] - targets[i + j - kStepWide];
      square += e[j] * e[j];
    }
    const float size = std::sqrt(square);
    loss += static_cast<double>(w * (size - f));
    for (std::size_t j = 0; j < count; ++j) {
      const float pull = w * e[j] / size;
      errors_[i + j] += pull;
      if (is_change) errors_[i + j - kStepWide] -= pull;
    }
    return size;
  };
  for (std::size_t t = kFirstJudgedStep; t < kTrackerSteps; ++t)
    for (std::size_t b = 0; b < kTrackerHalf; ++b) {
      const std::size_t i = t * kStepWide + b * kTrackerWideOutputs + from;
      const float size = add(i, false, weight, floor);
      if (from == TrackerRow::kAnkles) ankle_error += static_cast<double>(size);
      if (t > kFirstJudgedStep) add(i, true, pace * weight, kPaceFloor);
    }
}

void TrackerPasses::judge_stands() {
  for (std::size_t i = kFirstJudgedStep * kTrackerHalf; i < kTrackerRows; ++i)
    for (std::size_t side = 0; side < 2; ++side) {
      const std::size_t at = i * kTrackerWideOutputs + TrackerRow::kStands + side;
      const float odds = outputs_[at], stands = targets[at];
      loss += static_cast<double>(kStandsWeight * (std::log1p(std::exp(-std::abs(odds))) +
                                                   std::max(odds, 0.0f) - odds * stands));
      right += (odds > 0.0f) == (stands > 0.5f) ? 0.5 : 0.0;
      errors_[at] += kStandsWeight * (some_sigmoid(odds) - stands);
    }
}

void TrackerPasses::judge(const TrackerFloats& p) {
  loss = ankle_error = right = 0.0;
  for (std::size_t i = 0; i < kTrackerRows; ++i)
    std::copy_n(&p[places_.out_bias], kTrackerWideOutputs, &outputs_[i * kTrackerWideOutputs]);
  add_matrix_product(kept_.back().shown.data(), kTrackerUnits, 1, &p[places_.out],
                     kTrackerWideOutputs, outputs_.data(), kTrackerRows, kTrackerUnits,
                     kTrackerWideOutputs);
  std::fill(errors_.begin(), errors_.end(), 0.0f);
  std::size_t at = 0;
  for (std::size_t bone = 0; bone < kBoneCount; ++bone) {
    if (bone == index_of(Bone::kHead)) continue;
    judge_group(at, 6, kBoneWeights[bone], kTurnFloor, kPace);
    at += 6;
  }
  for (const std::size_t place : {TrackerRow::kHips, TrackerRow::kAnkles, TrackerRow::kAnkles + 3})
    judge_group(place, 3, kPlaceWeight, kPlaceFloor, kPace);
  judge_stands();
  const double judged = static_cast<double>((kTrackerSteps - kFirstJudgedStep) * kTrackerHalf);
  loss /= judged;
  ankle_error /= judged;
  right /= judged;
  const auto share = static_cast<float>(1.0 / judged);
  for (float& e : errors_) e *= share;
}

void TrackerPasses::backward_out(const TrackerFloats& p) {
  add_outer(kept_.back().shown.data(), kTrackerUnits, errors_.data(), kTrackerWideOutputs,
            &gradient[places_.out], kTrackerRows);
  for (std::size_t i = 0; i < kTrackerRows; ++i)
    for (std::size_t j = 0; j < kTrackerWideOutputs; ++j)
      gradient[places_.out_bias + j] += errors_[i * kTrackerWideOutputs + j];
  turn_matrix(&p[places_.out], kTrackerUnits, kTrackerWideOutputs, turned_);
  TrackerFloats& errors = kept_.back().errors;
  std::fill(errors.begin(), errors.end(), 0.0f);
  add_matrix_product(errors_.data(), kTrackerWideOutputs, 1, turned_.data(), kTrackerUnits,
                     errors.data(), kTrackerRows, kTrackerWideOutputs, kTrackerUnits);
}

void TrackerPasses::backward(const TrackerFloats& p, std::size_t l) {
  Kept& kept = kept_[l];
  const TrackerParameters::Layer& at = places_.layers[l];
  turn_matrix(&p[at.again], kTrackerUnits, kTrackerGates, turned_);
  std::fill(carried_.begin(), carried_.end(), 0.0f);
  for (std::size_t t = kTrackerSteps; t-- > 0;) {
    const std::size_t row = t * kRow;
    float* in = &kept.gates[t * kTrackerHalf * kTrackerGates];
    float* again = &kept.again_gates[t * kTrackerHalf * kTrackerGates];
    for (std::size_t b = 0; b < kTrackerHalf; ++b)
      for (std::size_t u = 0; u < kTrackerUnits; ++u) {
        const std::size_t g = b * kTrackerGates + u, k = b * kTrackerUnits + u, i = row + k;
        const float dh = carried_[k] + kept.errors[i] * kept.mask[k];
        const float z = kept.z[i], r = kept.r[i], n = kept.n[i];
        const float before = t > 0 ? kept.h[i - kRow] : 0.0f;
        const float dn = dh * (1.0f - z) * (1.0f - n * n);
        const float dz = dh * (before - n) * z * (1.0f - z);
        const float dr = dn * kept.again_n[i] * r * (1.0f - r);
        carried_next_[k] = dh * z;
        in[g] = again[g] = dz;
        in[g + kTrackerUnits] = again[g + kTrackerUnits] = dr;
        in[g + 2 * kTrackerUnits] = dn;
        again[g + 2 * kTrackerUnits] = dn * r;
      }
    add_matrix_product(again, kTrackerGates, 1, turned_.data(), kTrackerUnits, carried_next_.data(),
                       kTrackerHalf, kTrackerGates, kTrackerUnits);
    std::swap(carried_, carried_next_);
  }
  gather(l);
  if (l == 0) return;
  turn_matrix(&p[at.in], kTrackerUnits, kTrackerGates, turned_);
  TrackerFloats& errors = kept_[l - 1].errors;
  std::fill(errors.begin(), errors.end(), 0.0f);
  add_matrix_product(kept.gates.data(), kTrackerGates, 1, turned_.data(), kTrackerUnits,
                     errors.data(), kTrackerRows, kTrackerGates, kTrackerUnits);
}

// The gradient of a layer's parameters, from the errors of its gates.
void TrackerPasses::gather(std::size_t l) {
  const Kept& kept = kept_[l];
  const TrackerParameters::Layer& at = places_.layers[l];
  add_outer(below(l), TrackerParameters::inputs(l), kept.gates.data(), kTrackerGates,
            &gradient[at.in], kTrackerRows);
  add_outer(kept.h.data(), kTrackerUnits, &kept.again_gates[kTrackerHalf * kTrackerGates],
            kTrackerGates, &gradient[at.again], kTrackerRows - kTrackerHalf);
  for (std::size_t i = 0; i < kTrackerRows; ++i)
    for (std::size_t g = 0; g < kTrackerGates; ++g) {
      gradient[at.in_bias + g] += kept.gates[i * kTrackerGates + g];
      gradient[at.again_bias + g] += kept.again_gates[i * kTrackerGates + g];
    }
}

}  // namespace dance

#include "transformers/guess_proof.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// 30 moments a second: half-lives of 15 s and of 0.65 s.
constexpr float kShareKeep = 0.99846f;
constexpr float kErrorKeep = 0.965f;
// What a correction must have proved before it counts, as a part of what it would prove in the half-life.
constexpr float kCaution = 0.05f;
// As much as is right of the corrections of a dancer who was seen for some minutes.
constexpr float kShareOfAcquainted = 0.33f;
constexpr float kDampedRows = 6.0f;  // 100 ms
// From here on, of the best plain guess's error, the prediction gives way to it, and from there on wholly.
constexpr float kBegins = 0.86f, kWholly = 0.96f;
// What is wrong near at hand is known before what is wrong further ahead: so much of the way back of the three horizons
// before is taken too.
constexpr std::size_t kHorizonsBefore = 3;
constexpr float kFromNearer = 0.8f;
// A few moments that were worse say nothing yet.
constexpr float kHeardEnough_moments = 25.0f;
// Root of the sum of all joints' squared speeds, m/s: less is standing.
constexpr float kMoving_m_s = 0.4f;

const float* slope_of(const MomentGuesses& guesses, Guess guess) {
  return guesses.common[static_cast<std::size_t>(guess)].v.data();
}

}  // namespace

std::array<BodyRow, kPlainGuesses> plain_ways(const MomentGuesses& guesses, std::size_t horizon) {
  std::array<BodyRow, kPlainGuesses> ways;
  const auto rows = static_cast<float>(kHorizonFrames[horizon]);
  const float damped = kDampedRows * (1.0f - std::exp(-rows / kDampedRows));
  const float* last = slope_of(guesses, Guess::kSlope1);
  const float* lately = slope_of(guesses, Guess::kSlope6);
  for (std::size_t i = 0; i < kRowSize; ++i) {
    ways[1].v[i] = rows * last[i];
    ways[2].v[i] = damped * lately[i];
  }
  return ways;
}

GuessProof::GuessProof(const std::array<float, kRowGroups>& lever) : lever_(lever) {}

// Lengths, not their squares: what is seen of an error is how far it is.
float GuessProof::error_m(const BodyRow& said, const BodyRow& way) const {
  float sum = 0.0f;
  for (std::size_t g = 0; g < kBoneCount; ++g) {
    float squares = 0.0f;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float error = said(g, axis) - way(g, axis);
      squares += error * error;
    }
    sum += lever_[g] * std::sqrt(squares);
  }
  return sum;
}

bool GuessProof::is_moving(const MomentGuesses& guesses) const {
  const float* slope = slope_of(guesses, Guess::kSlope12);
  float squares = 0.0f;
  for (std::size_t g = 0; g < kBoneCount; ++g)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float speed = lever_[g] * slope[BodyRow::at(g, axis)];
      squares += speed * speed;
    }
  return squares * static_cast<float>(kGridHz * kGridHz) > kMoving_m_s * kMoving_m_s;
}

void GuessProof::clear() { horizons_ = {}; }

void GuessProof::forget_errors() {
  for (Horizon& horizon : horizons_) horizon.errors = {};
}

void GuessProof::doubt_personal() {
  for (Horizon& horizon : horizons_)
    for (std::size_t g = 0; g < kRowGroups; ++g) horizon.right[g] *= 0.9f, horizon.size[g] *= 0.9f;
}

void GuessProof::add_personal(std::size_t h, const MomentGuesses& guesses, BodyRow& way) const {
  for (std::size_t i = 0; i < kRowSize; ++i)
    way.v[i] += horizons_[h].share[i % kRowGroups] * guesses.personal[h].v[i];
}

float GuessProof::proved(std::size_t h, std::uint32_t presence) const {
  float sum = 0.0f, seen = 0.0f;
  for (std::size_t bone = 1; bone < kBoneCount; ++bone) {
    if ((presence >> bone & 1u) == 0) continue;
    sum += horizons_[h].share[bone];
    seen += 1.0f;
  }
  return seen > 0.0f ? std::min(1.0f, sum / (kShareOfAcquainted * seen)) : 0.0f;
}

void GuessProof::learn(std::size_t h, const MomentGuesses& guesses, const BodyRow& way) {
  Horizon& horizon = horizons_[h];
  const BodyRow& p = guesses.impersonal[h];
  const BodyRow& c = guesses.personal[h];
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
  const auto plain = plain_ways(guesses, h);
  Errors& errors = horizon.errors[is_moving(guesses) ? 1 : 0];
  errors.heard = kErrorKeep * errors.heard + 1.0f;
  errors.ours = kErrorKeep * errors.ours + error_m(guesses.blended[h], way);
  for (std::size_t b = 0; b < kPlainGuesses; ++b)
    errors.plain[b] = kErrorKeep * errors.plain[b] + error_m(plain[b], way);
}

float GuessProof::way_back(const Errors& errors) {
  const float best = *std::min_element(errors.plain.begin(), errors.plain.end());
  if (errors.ours <= kBegins * best) return 0.0f;
  return std::clamp((errors.ours / (best + 1e-9f) - kBegins) / (kWholly - kBegins), 0.0f, 1.0f) *
         std::clamp(errors.heard / kHeardEnough_moments, 0.0f, 1.0f);
}

void GuessProof::finish(std::size_t h, const MomentGuesses& guesses, BodyRow& way) const {
  const Horizon& horizon = horizons_[h];
  way = guesses.blended[h];
  const std::size_t state = is_moving(guesses) ? 1 : 0;
  float back = way_back(horizon.errors[state]);
  for (std::size_t nearer = h - std::min(h, kHorizonsBefore); nearer < h; ++nearer)
    back = std::max(back, kFromNearer * way_back(horizons_[nearer].errors[state]));
  if (back <= 0.0f) return;
  // The best here; before anything was heard here, standing still.
  const auto& errors = horizon.errors[state].plain;
  const auto best = std::min_element(errors.begin(), errors.end()) - errors.begin();
  const BodyRow plain = plain_ways(guesses, h)[static_cast<std::size_t>(best)];
  for (std::size_t i = 0; i < kRowSize; ++i) way.v[i] += back * (plain.v[i] - way.v[i]);
}

}  // namespace dance

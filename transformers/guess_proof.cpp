#include "transformers/guess_proof.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// 30 moments a second: half-lives of 15 s and of 4 s.
constexpr float kShareKeep = 0.99846f;
constexpr float kErrorKeep = 0.9942f;
// What a correction must have proved before it counts, as a part of what it would prove in the half-life.
constexpr float kCaution = 0.05f;
constexpr float kDampedRows = 6.0f;  // 100 ms
// From here on the prediction gives way to a plain one, and from there on wholly.
constexpr float kBegins = 0.92f, kWholly = 1.0f;

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

GuessProof::GuessProof(const std::array<float, kRowGroups>& lever) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t g = 0; g < kBoneCount; ++g)
      weight_[BodyRow::at(g, axis)] = lever[g] * lever[g];
}

void GuessProof::clear() { horizons_ = {}; }

void GuessProof::doubt_personal() {
  for (Horizon& horizon : horizons_)
    for (std::size_t g = 0; g < kRowGroups; ++g) horizon.right[g] *= 0.9f, horizon.size[g] *= 0.9f;
}

void GuessProof::learn(std::size_t h, const MomentGuesses& guesses, const BodyRow& way) {
  Horizon& horizon = horizons_[h];
  const BodyRow& p = guesses.blended[h];
  const BodyRow& c = guesses.personal[h];
  BodyRow done;
  finish(h, guesses, done);
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
  BodyRow mixed;
  for (std::size_t i = 0; i < kRowSize; ++i)
    mixed.v[i] = p.v[i] + horizon.share[i % kRowGroups] * c.v[i];
  const auto plain = plain_ways(guesses, h);
  const auto squares = [&](auto difference) {
    float sum = 0.0f;
    for (std::size_t i = 0; i < kRowSize; ++i) sum += weight_[i] * difference(i);
    return sum;
  };
  const auto square = [](float x) { return x * x; };
  horizon.error = kErrorKeep * horizon.error +
                  squares([&](std::size_t i) { return square(way.v[i] - mixed.v[i]); });
  for (std::size_t b = 0; b < kPlainGuesses; ++b) {
    horizon.plain_error[b] = kErrorKeep * horizon.plain_error[b] + squares([&](std::size_t i) {
                               return square(way.v[i] - plain[b].v[i]);
                             });
    horizon.plain_right[b] = kErrorKeep * horizon.plain_right[b] + squares([&](std::size_t i) {
                               return (way.v[i] - mixed.v[i]) * (plain[b].v[i] - mixed.v[i]);
                             });
    horizon.plain_size[b] = kErrorKeep * horizon.plain_size[b] + squares([&](std::size_t i) {
                              return square(plain[b].v[i] - mixed.v[i]);
                            });
  }
}

void GuessProof::finish(std::size_t h, const MomentGuesses& guesses, BodyRow& way) const {
  const Horizon& horizon = horizons_[h];
  const BodyRow& p = guesses.blended[h];
  const BodyRow& c = guesses.personal[h];
  for (std::size_t i = 0; i < kRowSize; ++i)
    way.v[i] = p.v[i] + horizon.share[i % kRowGroups] * c.v[i];
  std::size_t best = 0;
  for (std::size_t b = 1; b < kPlainGuesses; ++b)
    if (horizon.plain_error[b] < horizon.plain_error[best]) best = b;
  const float least = horizon.plain_error[best];
  if (horizon.error <= kBegins * least || horizon.plain_size[best] <= 0.0f) return;
  const float urgency =
      std::clamp((horizon.error / (least + 1e-12f) - kBegins) / (kWholly - kBegins), 0.0f, 1.0f);
  const float back =
      urgency * std::clamp(horizon.plain_right[best] / horizon.plain_size[best], 0.0f, 1.0f);
  const BodyRow plain = plain_ways(guesses, h)[best];
  for (std::size_t i = 0; i < kRowSize; ++i) way.v[i] += back * (plain.v[i] - way.v[i]);
}

}  // namespace dance

#include "testing/voice/sound_match.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// Compared at 8 kHz.
constexpr std::size_t kEach = 6;
constexpr double kMatch_hz = 48'000.0 / kEach;
constexpr std::size_t kPiece = 3200;
constexpr double kQuietPiece = 1e-4;
constexpr double kFits = 0.5;

std::vector<float> coarser(std::span<const float> samples) {
  std::vector<float> out(samples.size() / kEach);
  for (std::size_t i = 0; i < out.size(); ++i) {
    float sum = 0.0f;
    for (std::size_t k = 0; k < kEach; ++k) sum += samples[i * kEach + k];
    out[i] = sum / static_cast<float>(kEach);
  }
  return out;
}

double product(const float* a, const float* b) {
  float sum = 0.0f;
  for (std::size_t i = 0; i < kPiece; ++i) sum += a[i] * b[i];
  return static_cast<double>(sum);
}

}  // namespace

std::vector<SoundMatch> match_sound(std::span<const float> spoken, std::span<const float> heard,
                                    double least_ms, double most_ms) {
  const std::vector<float> a = coarser(spoken), b = coarser(heard);
  const auto first = static_cast<std::ptrdiff_t>(least_ms * 1e-3 * kMatch_hz);
  const auto last = static_cast<std::ptrdiff_t>(most_ms * 1e-3 * kMatch_hz);
  std::vector<SoundMatch> matches;
  for (std::size_t at = 0; at + kPiece <= a.size(); at += kPiece) {
    const double power = product(&a[at], &a[at]);
    if (power < kQuietPiece * kQuietPiece * kPiece * 100) continue;
    SoundMatch best{static_cast<double>(at) / kMatch_hz, 0.0, 0.0};
    bool has_room = false;
    for (std::ptrdiff_t lag = first; lag <= last; ++lag) {
      const std::ptrdiff_t in_b = static_cast<std::ptrdiff_t>(at) + lag;
      if (in_b < 0 ||
          in_b + static_cast<std::ptrdiff_t>(kPiece) > static_cast<std::ptrdiff_t>(b.size()))
        continue;
      has_room = true;
      const float* other = &b[static_cast<std::size_t>(in_b)];
      const double other_power = product(other, other);
      const double likeness = product(&a[at], other) / std::sqrt(power * other_power + 1e-12);
      if (likeness <= best.likeness) continue;
      best.likeness = likeness;
      best.delay_ms = static_cast<double>(lag) / kMatch_hz * 1e3;
    }
    if (has_room) matches.push_back(best);
  }
  return matches;
}

MatchFigures figures_of(const std::vector<SoundMatch>& matches) {
  MatchFigures figures;
  figures.pieces = matches.size();
  std::vector<double> delays;
  for (const SoundMatch& match : matches)
    if (match.likeness >= kFits) delays.push_back(match.delay_ms);
  figures.fitting = delays.size();
  if (delays.empty()) return figures;
  std::sort(delays.begin(), delays.end());
  figures.median_ms = delays[delays.size() / 2];
  figures.p95_ms = delays[std::min(delays.size() - 1, delays.size() * 95 / 100)];
  return figures;
}

}  // namespace dance

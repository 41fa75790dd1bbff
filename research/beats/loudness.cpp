#include "research/beats/loudness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace dance {
namespace {

constexpr double kSilence_lufs = -70.0;
constexpr std::size_t kStep_frames = 4800;  // 100 ms
constexpr std::size_t kSteps_of_block = 4;

struct Biquad {
  double b0, b1, b2, a1, a2;
  double x1 = 0.0, x2 = 0.0, y1 = 0.0, y2 = 0.0;

  double filter(double x) {
    const double y = b0 * x + b1 * x1 + b2 * x2 - a1 * y1 - a2 * y2;
    x2 = x1;
    x1 = x;
    y2 = y1;
    y1 = y;
    return y;
  }
};

// The head's shelf and the ear's high-pass, at 48 kHz as the standard gives them.
struct Weighting {
  Biquad shelf{1.53512485958697, -2.69169618940638, 1.19839281085285, -1.69065929318241,
               0.73248077421585};
  Biquad high_pass{1.0, -2.0, 1.0, -1.99004745483398, 0.99007225036621};

  double filter(double x) { return high_pass.filter(shelf.filter(x)); }
};

double lufs_of(double power) {
  return power > 0.0 ? -0.691 + 10.0 * std::log10(power) : kSilence_lufs;
}

// The mean power of all blocks that are louder than the gate.
double gated_power(const std::vector<double>& blocks, double gate_lufs) {
  double sum = 0.0;
  int count = 0;
  for (const double power : blocks)
    if (lufs_of(power) > gate_lufs) {
      sum += power;
      ++count;
    }
  return count > 0 ? sum / count : 0.0;
}

}  // namespace

double loudness_lufs(std::span<const float> stereo) {
  std::array<Weighting, 2> ears;
  std::vector<double> steps;
  for (std::size_t begin = 0; begin + 2 * kStep_frames <= stereo.size();
       begin += 2 * kStep_frames) {
    double energy = 0.0;
    for (std::size_t i = begin; i < begin + 2 * kStep_frames; ++i) {
      const double weighted = ears[i % 2].filter(stereo[i]);
      energy += weighted * weighted;
    }
    steps.push_back(energy / kStep_frames);
  }
  std::vector<double> blocks;
  for (std::size_t i = 0; i + kSteps_of_block <= steps.size(); ++i)
    blocks.push_back((steps[i] + steps[i + 1] + steps[i + 2] + steps[i + 3]) / kSteps_of_block);
  const double loud = lufs_of(gated_power(blocks, kSilence_lufs));
  return std::max(kSilence_lufs, lufs_of(gated_power(blocks, loud - 10.0)));
}

}  // namespace dance

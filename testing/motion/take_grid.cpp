#include "testing/motion/take_grid.h"

#include <cmath>
#include <complex>
#include <numbers>

namespace dance {
namespace {

using Complex = std::complex<double>;

constexpr double kSlowestTake_bpm = 80.0, kFastestTake_bpm = 220.0, kTakeStep_bpm = 0.1;
// People step to what lies about here; half and double of it are told apart by that alone.
constexpr double kUsualTempo_bpm = 150.0, kUsualSpread_octaves = 0.45;

// How fast the feet go, without what changes more slowly than a bar, windowed.
std::vector<double> foot_speed(const JointTrack& track) {
  const std::size_t n = track.size();
  std::vector<double> speed(n, 0.0);
  for (std::size_t i = 1; i < n; ++i)
    for (const Bone foot : {Bone::kLeftToes, Bone::kRightToes}) {
      const Eigen::Vector3f way =
          track.world[i][index_of(foot)] - track.world[i - 1][index_of(foot)];
      speed[i] += static_cast<double>(way.norm()) * track.hz;
    }
  const auto reach = static_cast<std::size_t>(track.hz);
  std::vector<double> sums(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) sums[i + 1] = sums[i] + speed[i];
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t from = i < reach ? 0 : i - reach, to = std::min(n, i + reach + 1);
    const double window = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) /
                                               static_cast<double>(n));
    speed[i] = (speed[i] - (sums[to] - sums[from]) / static_cast<double>(to - from)) * window;
  }
  return speed;
}

Complex turn_of(const std::vector<double>& signal, double hz, double frequency_hz) {
  const Complex step = std::polar(1.0, -2.0 * std::numbers::pi * frequency_hz / hz);
  Complex turn = 1.0, sum = 0.0;
  for (const double value : signal) {
    sum += value * turn;
    turn *= step;
  }
  return sum;
}

}  // namespace

TakeGrid find_take_grid(const JointTrack& track) {
  TakeGrid grid;
  const std::vector<double> speed = foot_speed(track);
  double energy = 0.0, best = -1.0;
  for (const double value : speed) energy += value * value;
  Complex beat_turn = 0.0;
  for (double bpm = kSlowestTake_bpm; bpm <= kFastestTake_bpm; bpm += kTakeStep_bpm) {
    const double beat_hz = bpm / 60.0;
    const Complex beat = turn_of(speed, track.hz, beat_hz);
    // Every beat, every second and every fourth: a step, a weight and a bar.
    const double power = std::norm(beat) + std::norm(turn_of(speed, track.hz, beat_hz / 2.0)) +
                         std::norm(turn_of(speed, track.hz, beat_hz / 4.0));
    const double octaves = std::log2(bpm / kUsualTempo_bpm) / kUsualSpread_octaves;
    const double score = power * std::exp(-0.5 * octaves * octaves);
    if (score <= best) continue;
    best = score;
    grid.tempo_bpm = bpm;
    grid.strength = energy > 0.0 ? 2.0 * power / (energy * static_cast<double>(speed.size())) : 0.0;
    beat_turn = beat;
  }
  if (grid.tempo_bpm <= 0.0) grid.tempo_bpm = kUsualTempo_bpm;
  // A foot is fastest between beats and stands on them: the beat is where the speed's wave is
  // least.
  const double period_s = 60.0 / grid.tempo_bpm;
  const double fastest_s = -std::arg(beat_turn) / (2.0 * std::numbers::pi) * period_s;
  grid.first_beat_s = std::fmod(fastest_s + 0.5 * period_s + 4.0 * period_s, period_s);
  return grid;
}

}  // namespace dance

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/assert.h"
#include "core/base/random.h"
#include "producers/music/tracker/bar_pointer.h"
#include "research/beats/music_training.h"

namespace dance {
namespace {

constexpr double kRidge = 2.0;
constexpr int kDescents = 60;
constexpr int kStarts = 6;
constexpr int kTurns = 40;
// A pattern knows the tempi of the songs that have it in at least so many of their bars, and a
// little more.
constexpr double kShare = 0.15;
constexpr double kWider = 1.2;
constexpr int kLeastOfUse_bpm = 75;
constexpr int kMostOfUse_bpm = 200;
constexpr int kLeastKnown_bpm = 60;
constexpr int kMostKnown_bpm = 240;

// One bar's place: beats from the first, of four.
constexpr std::size_t kPlaces = kPatternPlaces_beats.size();

// Least squares with no weight below 0, by coordinate descent: strengths as a floor and a stroke at
// each slot.
std::array<float, kPatternSlots> strokes_of_group(
    std::span<const OnsetStrength::Strengths> strengths, std::span<const double> times_s,
    std::span<const double> beats_s, std::size_t group, double mean) {
  constexpr auto kSlots = static_cast<Eigen::Index>(kPatternSlots);
  const auto n = static_cast<Eigen::Index>(strengths.size());
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(n, kSlots + 1);
  shapes.col(kSlots).setOnes();
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < n; ++i)
    y[i] =
        std::min(strengths[static_cast<std::size_t>(i)][group], BarPointer::kMostStrength) / mean;
  for (std::size_t beat = 0; beat + 1 < beats_s.size(); ++beat)
    for (std::size_t place = 0; place < kPlaces; ++place) {
      const double centre_s = beats_s[beat] +
                              kPatternPlaces_beats[place] * (beats_s[beat + 1] - beats_s[beat]) +
                              BarPointer::kLater_s[group];
      auto shape = shapes.col(static_cast<Eigen::Index>(beat % kPatternBeats * kPlaces + place));
      for (Eigen::Index i = 0; i < n; ++i) {
        const double away =
            (times_s[static_cast<std::size_t>(i)] - centre_s) / BarPointer::kBlur_s[group];
        if (std::abs(away) < 5.0) shape[i] += std::exp(-0.5 * away * away);
      }
    }
  Eigen::MatrixXd square = shapes.transpose() * shapes;
  square.diagonal().head(kSlots).array() += kRidge;
  const Eigen::VectorXd target = shapes.transpose() * y;
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(kSlots + 1);
  for (int turn = 0; turn < kDescents; ++turn)
    for (Eigen::Index j = 0; j <= kSlots; ++j) {
      if (square(j, j) <= 0.0) continue;
      const double rest = target[j] - square.row(j).dot(weights) + square(j, j) * weights[j];
      weights[j] = std::max(0.0, rest / square(j, j));
    }
  std::array<float, kPatternSlots> out{};
  for (std::size_t j = 0; j < kPatternSlots; ++j)
    out[j] = static_cast<float>(weights[static_cast<Eigen::Index>(j)]);
  return out;
}

// Kinds are told apart by the roots of strokes, so that one loud drum is not everything. Which beat
// of a bar is the first says nothing: a bar may be turned.
struct Bar {
  const TrainingSong* song;
  float weight;
  std::array<BarStrokes, kPatternBeats> turned;  // roots
  std::size_t kind = 0;
  std::size_t turn = 0;
};

BarStrokes turn_bar(const BarStrokes& bar, std::size_t beats) {
  BarStrokes out;
  for (std::size_t g = 0; g < kOnsetGroups; ++g)
    for (std::size_t s = 0; s < kPatternSlots; ++s)
      out[g][s] = bar[g][(s + beats * kPlaces) % kPatternSlots];
  return out;
}

float distance(const BarStrokes& a, const BarStrokes& b) {
  float sum = 0.0f;
  for (std::size_t g = 0; g < kOnsetGroups; ++g)
    for (std::size_t s = 0; s < kPatternSlots; ++s)
      sum += (a[g][s] - b[g][s]) * (a[g][s] - b[g][s]);
  return sum;
}

// To the nearest of some kinds; sets which and how the bar is turned.
float choose(Bar& bar, std::span<const BarStrokes> kinds) {
  float least = std::numeric_limits<float>::max();
  for (std::size_t k = 0; k < kinds.size(); ++k)
    for (std::size_t t = 0; t < kPatternBeats; ++t) {
      const float d = distance(bar.turned[t], kinds[k]);
      if (d >= least) continue;
      least = d;
      bar.kind = k;
      bar.turn = t;
    }
  return least * bar.weight;
}

const Bar& draw_bar(const std::vector<Bar>& bars, std::span<const double> weights, Random& random) {
  double sum = 0.0;
  for (const double w : weights) sum += w;
  double left = random.uniform() * sum;
  for (std::size_t i = 0; i < bars.size(); ++i)
    if ((left -= weights[i]) <= 0.0) return bars[i];
  return bars.back();
}

double settle(std::vector<Bar>& bars, std::size_t count, Random& random) {
  std::vector<BarStrokes> kinds;
  std::vector<double> weights;
  for (const Bar& bar : bars) weights.push_back(bar.weight);
  while (kinds.size() < count) {
    kinds.push_back(draw_bar(bars, weights, random).turned[0]);
    for (std::size_t i = 0; i < bars.size(); ++i) weights[i] = choose(bars[i], kinds);
  }
  double cost = 0.0;
  for (int turn = 0; turn < kTurns; ++turn) {
    std::vector<BarStrokes> sums(count, BarStrokes{});
    std::vector<float> sum_weights(count, 0.0f);
    for (const Bar& bar : bars) {
      sum_weights[bar.kind] += bar.weight;
      for (std::size_t g = 0; g < kOnsetGroups; ++g)
        for (std::size_t s = 0; s < kPatternSlots; ++s)
          sums[bar.kind][g][s] += bar.weight * bar.turned[bar.turn][g][s];
    }
    for (std::size_t k = 0; k < count; ++k) {
      if (sum_weights[k] <= 0.0f) continue;
      for (auto& row : sums[k])
        for (float& x : row) x /= sum_weights[k];
      kinds[k] = sums[k];
    }
    cost = 0.0;
    for (Bar& bar : bars) cost += choose(bar, kinds);
  }
  return cost;
}

MeterPattern pattern_of(const std::vector<Bar>& bars, std::size_t kind,
                        const std::vector<const TrainingSong*>& songs) {
  BarStrokes sum{};
  for (const Bar& bar : bars) {
    if (bar.kind != kind) continue;
    for (std::size_t g = 0; g < kOnsetGroups; ++g)
      for (std::size_t s = 0; s < kPatternSlots; ++s) {
        const float root = bar.turned[bar.turn][g][s];
        sum[g][s] += bar.weight * root * root;
      }
  }
  MeterPattern pattern{kMostKnown_bpm, kLeastKnown_bpm, {}};
  for (const TrainingSong* song : songs) {
    double share = 0.0;
    for (const Bar& bar : bars)
      if (bar.song == song && bar.kind == kind) share += bar.weight;
    if (share < kShare * song->weight) continue;
    const auto bound = [](double bpm) {
      return std::clamp(static_cast<int>(std::lround(bpm)), kLeastKnown_bpm, kMostKnown_bpm);
    };
    pattern.least_tempo_bpm =
        std::min(pattern.least_tempo_bpm, bound(song->least_tempo_bpm / kWider));
    pattern.most_tempo_bpm = std::max(pattern.most_tempo_bpm, bound(song->most_tempo_bpm * kWider));
  }
  for (std::size_t g = 0; g < kOnsetGroups; ++g) {
    const float most = std::max(1e-6f, *std::max_element(sum[g].begin(), sum[g].end()));
    for (std::size_t s = 0; s < kPatternSlots; ++s)
      pattern.weights[g][s] = static_cast<std::uint8_t>(std::lround(100.0f * sum[g][s] / most));
  }
  return pattern;
}

}  // namespace

BarStrokes strokes_of_bars(std::span<const OnsetStrength::Strengths> strengths,
                           std::span<const double> hop_times_s, std::span<const double> beats_s) {
  DANCE_ASSERT(beats_s.size() % kPatternBeats == 1 && strengths.size() == hop_times_s.size());
  BarStrokes bars{};
  for (std::size_t g = 0; g < kOnsetGroups; ++g) {
    double mean = 0.0;
    for (const auto& s : strengths)
      mean += std::min(s[g], BarPointer::kMostStrength) / static_cast<double>(strengths.size());
    bars[g] = strokes_of_group(strengths, hop_times_s, beats_s, g, std::max(mean, 0.1));
  }
  return bars;
}

std::vector<MeterPattern> fit_patterns(const std::vector<const TrainingSong*>& songs,
                                       const MusicTraining& training) {
  std::vector<Bar> bars;
  for (const TrainingSong* song : songs)
    for (const BarStrokes& strokes : song->bars) {
      BarStrokes roots = strokes;
      for (auto& row : roots)
        for (float& x : row) x = std::sqrt(x);
      Bar bar{song, song->weight / static_cast<float>(song->bars.size()), {}};
      for (std::size_t t = 0; t < kPatternBeats; ++t) bar.turned[t] = turn_bar(roots, t);
      bars.push_back(bar);
    }
  const std::size_t count = std::min(
      {static_cast<std::size_t>(training.patterns), bars.size(), BeatModel::kMostPatterns});
  Random random(training.seed);
  std::vector<Bar> best;
  double least = std::numeric_limits<double>::max();
  for (int start = 0; start < kStarts; ++start) {
    std::vector<Bar> trial = bars;
    const double cost = settle(trial, count, random);
    if (cost >= least) continue;
    least = cost;
    best = std::move(trial);
  }
  std::vector<MeterPattern> patterns;
  for (std::size_t kind = 0; kind < count; ++kind) {
    const MeterPattern pattern = pattern_of(best, kind, songs);
    if (pattern.least_tempo_bpm < pattern.most_tempo_bpm &&
        pattern.most_tempo_bpm >= kLeastOfUse_bpm && pattern.least_tempo_bpm <= kMostOfUse_bpm)
      patterns.push_back(pattern);
  }
  return patterns;
}

}  // namespace dance

#include "research/beats/rhythm_net_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/assert.h"
#include "core/base/random.h"
#include "research/beats/rhythm_net_passes.h"
#include "research/in_two_threads.h"

namespace dance {
namespace {

constexpr std::size_t kMostSequence_steps = 1000;
// How another mix, room or instrument may change each feature for a whole sequence, and what is
// never the same twice.
constexpr float kGainSpread = 0.3f, kNoise = 0.25f;
constexpr double kFastest = 2e-3, kSlowest = 2e-5;  // rates
constexpr double kMostGradient = 1.0;

class RhythmTrainer {
 public:
  RhythmTrainer(const std::vector<WeightedRhythm>& songs, std::uint64_t seed)
      : random_(seed),
        sequence_steps_(steps_of(songs)),
        adam_(places_.count),
        halves_{RhythmPasses(places_, sequence_steps_), RhythmPasses(places_, sequence_steps_)} {
    for (const auto& [song, weight] : songs) {
      songs_.push_back(song);
      total_ += static_cast<double>(weight);
      until_.push_back(total_);
    }
    DANCE_ASSERT(!songs_.empty());
    find_scale();
    for (float& x : noise_) x = static_cast<float>(random_.normal());
    parameters_ = places_.drawn(random_);
    // Units remember at first.
    for (const RhythmPlaces::Layer& layer : places_.layers)
      std::fill_n(&parameters_[layer.in_bias], kRhythmUnits, 1.0f);
  }

  RhythmNet train(const RhythmFit& fit) {
    double loss = 0.0, tempo_loss = 0.0, right = 0.0, weights = 0.0;
    for (int round = 0; round < fit.rounds; ++round) {
      for (RhythmPasses& half : halves_) choose(half);
      const std::uint64_t seeds[2] = {random_.next_u64(), random_.next_u64()};
      in_two_threads(2, [&](std::size_t i) {
        Random random(seeds[i]);
        halves_[i].run(parameters_, random);
      });
      const double part = static_cast<double>(round) / fit.rounds;
      const double warm = std::min(1.0, (round + 1) / 50.0);
      learn(warm *
            (kSlowest + (kFastest - kSlowest) * 0.5 * (1.0 + std::cos(std::numbers::pi * part))));
      for (const RhythmPasses& half : halves_) {
        loss += half.loss;
        tempo_loss += half.tempo_loss;
        right += half.right;
        weights += half.weights;
      }
      if ((round + 1) % 50 == 0) {
        char text[160];
        std::snprintf(text, sizeof text,
                      "round %d of %d: loss %.4f, of the tempo %.4f, which is right in %.1f %%",
                      round + 1, fit.rounds, loss / weights, tempo_loss / weights,
                      100.0 * right / weights);
        fit.tell(text);
        loss = tempo_loss = right = weights = 0.0;
      }
    }
    return net();
  }

 private:
  static std::size_t steps_of(const std::vector<WeightedRhythm>& songs) {
    std::size_t most = 1;
    for (const WeightedRhythm& of : songs) most = std::max(most, of.song->classes.size());
    return std::min(most, kMostSequence_steps);
  }

  void find_scale() {
    std::array<double, RhythmNet::kInputs> sum{}, squares{};
    double count = 0.0;
    for (const RhythmSong* song : songs_)
      for (std::size_t k = 0; k < song->classes.size(); k += 7) {
        for (std::size_t i = 0; i < sum.size(); ++i) {
          const double x = song->features[k * sum.size() + i];
          sum[i] += x, squares[i] += x * x;
        }
        count += 1.0;
      }
    for (std::size_t i = 0; i < sum.size(); ++i) {
      mean_[i] = static_cast<float>(sum[i] / count);
      scale_[i] = static_cast<float>(
          1.0 /
          (std::sqrt(std::max(0.0, squares[i] / count - std::pow(sum[i] / count, 2))) + 1e-2));
    }
  }

  void choose(RhythmPasses& half) {
    constexpr auto kInputs = static_cast<std::size_t>(RhythmNet::kInputs);
    for (std::size_t b = 0; b < kRhythmHalfBatch; ++b) {
      const auto at = std::upper_bound(until_.begin(), until_.end(), random_.uniform() * total_);
      const RhythmSong& song = *songs_[std::min<std::size_t>(
          static_cast<std::size_t>(at - until_.begin()), songs_.size() - 1)];
      half.songs[b] = &song;
      const std::size_t steps = song.classes.size();
      half.first[b] =
          steps > sequence_steps_ ? random_.below(steps - sequence_steps_) : std::size_t{0};
      const std::size_t shift = random_.below(noise_.size());
      std::array<float, kInputs> gain;
      for (float& g : gain) g = std::exp(kGainSpread * static_cast<float>(random_.normal()));
      for (std::size_t t = 0; t < sequence_steps_; ++t) {
        float* to = &half.inputs[(t * kRhythmHalfBatch + b) * kRhythmWideInputs];
        std::fill_n(to, kRhythmWideInputs, 0.0f);
        if (half.first[b] + t >= steps) continue;
        const float* from = &song.features[(half.first[b] + t) * kInputs];
        for (std::size_t i = 0; i < kInputs; ++i)
          to[i] = (gain[i] * from[i] - mean_[i]) * scale_[i] +
                  kNoise * noise_[(t * kInputs + i + shift) % noise_.size()];
      }
    }
  }

  void learn(double rate) {
    const double weights = std::max(halves_[0].weights + halves_[1].weights, 1.0);
    RhythmFloats& g = halves_[0].gradient;
    for (std::size_t i = 0; i < g.size(); ++i)
      g[i] = static_cast<float>((g[i] + halves_[1].gradient[i]) / weights);
    adam_.see(g, kMostGradient);
    for (std::size_t i = 0; i < g.size(); ++i)
      parameters_[i] -= static_cast<float>(rate * adam_.mean(i) / adam_.spread(i));
  }

  // Takes features as they are.
  RhythmNet net() const {
    RhythmNet net = places_.net<RhythmNet>(parameters_);
    for (Eigen::Index i = 0; i < RhythmNet::kInputs; ++i) {
      net.layers[0].in.col(i) *= scale_[static_cast<std::size_t>(i)];
      net.layers[0].in_bias -= net.layers[0].in.col(i) * mean_[static_cast<std::size_t>(i)];
    }
    return net;
  }

  RhythmPlaces places_;
  Random random_;
  std::vector<const RhythmSong*> songs_;
  std::vector<double> until_;
  std::size_t sequence_steps_;
  double total_ = 0.0;
  std::array<float, RhythmNet::kInputs> mean_{}, scale_{};
  RhythmFloats noise_ = RhythmFloats(1 << 20);
  RhythmFloats parameters_;
  ClippedAdam adam_;
  std::array<RhythmPasses, 2> halves_;
};

}  // namespace

RhythmNet fit_rhythm_net(const std::vector<WeightedRhythm>& songs, const RhythmFit& fit) {
  return RhythmTrainer(songs, fit.seed).train(fit);
}

}  // namespace dance

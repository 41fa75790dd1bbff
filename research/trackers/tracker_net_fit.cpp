#include "research/trackers/tracker_net_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/base/assert.h"
#include "research/in_two_threads.h"
#include "research/trackers/tracker_net_passes.h"

namespace dance {
namespace {

constexpr double kQuickest = 2e-3, kSlowest = 2e-5;  // rates
constexpr double kMostGradient = 2.0;
constexpr double kMeanOver = 0.997;
constexpr double kDecay = 0.01;  // of the weights, in the unit of the rate

class TrackerTrainer {
 public:
  TrackerTrainer(const std::vector<TrackerDance>& dances, std::uint64_t seed)
      : dances_(dances),
        random_(seed),
        adam_(places_.count),
        halves_{TrackerPasses(places_), TrackerPasses(places_)} {
    for (const TrackerDance& dance : dances_) {
      DANCE_ASSERT(dance.frames.size() > kTrackerSteps + 1);
      total_ += static_cast<double>(dance.frames.size());
      until_.push_back(total_);
    }
    DANCE_ASSERT(!dances_.empty());
    parameters_ = places_.drawn(random_);
    mean_ = parameters_;
  }

  TrackerNet train(const TrackerFit& fit) {
    double loss = 0.0, ankles = 0.0, right = 0.0;
    for (int round = 0; round < fit.rounds; ++round) {
      const std::uint64_t seeds[2] = {random_.next_u64(), random_.next_u64()};
      in_two_threads(2, [&](std::size_t i) {
        Random random(seeds[i]);
        choose(halves_[i], random);
        halves_[i].run(parameters_, random);
      });
      const double part = static_cast<double>(round) / fit.rounds;
      const double warm = std::min(1.0, (round + 1) / 50.0);
      learn(warm *
            (kSlowest + (kQuickest - kSlowest) * 0.5 * (1.0 + std::cos(std::numbers::pi * part))));
      for (const TrackerPasses& half : halves_) {
        loss += half.loss / 100.0;
        ankles += half.ankle_error / 100.0;
        right += half.right / 100.0;
      }
      if ((round + 1) % 50 != 0) continue;
      char text[160];
      std::snprintf(text, sizeof text, "round %d of %d: loss %.4f, ankle %.3f m, stance %.1f %%",
                    round + 1, fit.rounds, loss, ankles, 100.0 * right);
      fit.tell(text);
      loss = ankles = right = 0.0;
    }
    return places_.net<TrackerNet>(mean_);
  }

 private:
  void choose(TrackerPasses& half, Random& random) const {
    TrackerFloats inputs(kTrackerSteps * kTrackerWideInputs, 0.0f);
    TrackerFloats targets(kTrackerSteps * kTrackerWideOutputs, 0.0f);
    for (std::size_t b = 0; b < kTrackerHalf; ++b) {
      const auto at = std::upper_bound(until_.begin(), until_.end(), random.uniform() * total_);
      const TrackerDance& dance = dances_[std::min<std::size_t>(
          static_cast<std::size_t>(at - until_.begin()), dances_.size() - 1)];
      const std::size_t first = random.below(dance.frames.size() - kTrackerSteps - 1);
      draw_tracker_sequence(dance, first, kTrackerSteps, random, inputs.data(), kTrackerWideInputs,
                            targets.data(), kTrackerWideOutputs);
      for (std::size_t t = 0; t < kTrackerSteps; ++t) {
        const std::size_t row = t * kTrackerHalf + b;
        std::copy_n(&inputs[t * kTrackerWideInputs], kTrackerWideInputs,
                    &half.inputs[row * kTrackerWideInputs]);
        std::copy_n(&targets[t * kTrackerWideOutputs], kTrackerWideOutputs,
                    &half.targets[row * kTrackerWideOutputs]);
      }
    }
  }

  void learn(double rate) {
    TrackerFloats& g = halves_[0].gradient;
    for (std::size_t i = 0; i < g.size(); ++i) g[i] = 0.5f * (g[i] + halves_[1].gradient[i]);
    adam_.see(g, kMostGradient);
    const double kept = std::min(kMeanOver, (adam_.steps() + 1.0) / (adam_.steps() + 10.0));
    for (std::size_t i = 0; i < g.size(); ++i) {
      const double step = adam_.mean(i) / adam_.spread(i);
      parameters_[i] -=
          static_cast<float>(rate * (step + kDecay * static_cast<double>(parameters_[i])));
      mean_[i] += static_cast<float>(1.0 - kept) * (parameters_[i] - mean_[i]);
    }
  }

  const std::vector<TrackerDance>& dances_;
  TrackerParameters places_;
  Random random_;
  std::vector<double> until_;
  double total_ = 0.0;
  TrackerFloats parameters_, mean_;
  ClippedAdam adam_;
  std::array<TrackerPasses, 2> halves_;
};

}  // namespace

TrackerNet fit_tracker_net(const std::vector<TrackerDance>& dances, const TrackerFit& fit) {
  return TrackerTrainer(dances, fit.seed).train(fit);
}

}  // namespace dance

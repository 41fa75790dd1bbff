// TrackerPasses: half a batch of sequences through a recurrent network and back: its loss, and the
// gradient of that for each parameter.
//
// Units/frames: rows by step and sequence; parameters in one row (TrackerParameters).
// Ownership:    owns what a pass keeps of each step.
// Threads:      none inside; several may run at the same time on the same parameters.
// Failure:      none.
// Source:       back-propagation through time (Werbos, 1990).
#pragma once

#include <vector>

#include "core/base/random.h"
#include "producers/trackers/net/tracker_net.h"
#include "research/recurrent_fit.h"

namespace dance {

constexpr std::size_t kTrackerHalf = 16, kTrackerSteps = 144;
constexpr std::size_t kTrackerUnits = TrackerNet::kUnits, kTrackerGates = TrackerNet::kGates;
constexpr std::size_t kTrackerWideInputs = (TrackerRow::kInputs + 31) / 32 * 32;
constexpr std::size_t kTrackerWideOutputs = (TrackerRow::kOutputs + 31) / 32 * 32;
constexpr std::size_t kTrackerRows = kTrackerSteps * kTrackerHalf;

using TrackerFloats = std::vector<float>;

using TrackerParameters =
    RecurrentPlaces<kTrackerWideInputs, kTrackerUnits, kTrackerWideOutputs, TrackerNet::kLayers>;

class TrackerPasses {
 public:
  explicit TrackerPasses(const TrackerParameters& places);

  TrackerFloats inputs, targets;  // step, sequence, number
  TrackerFloats gradient;
  double loss = 0.0, ankle_error = 0.0, right = 0.0;  // means over what was judged

  void run(const TrackerFloats& p, Random& random);

 private:
  struct Kept {
    TrackerFloats z, r, n, again_n, h, shown, mask, gates, again_gates, errors;
  };

  const float* below(std::size_t layer) const {
    return layer == 0 ? inputs.data() : kept_[layer - 1].shown.data();
  }
  void forward(const TrackerFloats& p, std::size_t layer);
  void judge(const TrackerFloats& p);
  void judge_group(std::size_t from, std::size_t count, float weight, float floor, float pace);
  void judge_stands();
  void backward_out(const TrackerFloats& p);
  void backward(const TrackerFloats& p, std::size_t layer);
  void gather(std::size_t layer);

  const TrackerParameters& places_;
  std::array<Kept, TrackerNet::kLayers> kept_;
  TrackerFloats outputs_, errors_, carried_, carried_next_, turned_;
};

}  // namespace dance

// TrackerNet: a small recurrent network that guesses a whole body from the points that are tracked,
// step by step.
//
// Units/frames: rows as tracker_features.h has them; TrackerRow::kStep_hz steps a second.
// Ownership:    a plain value; a state belongs to one stream of steps. step() never allocates.
// Threads:      none inside; const use from any.
// Failure:      none.
// Source:       gated recurrent units (Cho et al., EMNLP 2014).
#pragma once

#include "producers/trackers/net/tracker_features.h"

namespace dance {

struct TrackerNet {
  static constexpr int kLayers = 2;
  static constexpr int kUnits = 128;
  static constexpr int kGates = 3 * kUnits;  // update, reset, new

  struct Layer {
    Eigen::MatrixXf in, again;
    Eigen::VectorXf in_bias, again_bias;
  };
  struct State {
    State();
    std::array<Eigen::VectorXf, kLayers> units;
    Eigen::VectorXf in, again;
    TrackerRow::Outputs outputs{};

    void clear();
  };

  std::array<Layer, kLayers> layers;
  Eigen::MatrixXf out;
  Eigen::VectorXf out_bias;

  TrackerNet();

  // What it says is in state.outputs.
  void step(const TrackerRow::Inputs& inputs, State& state) const;
};

}  // namespace dance

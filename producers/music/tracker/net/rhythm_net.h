// RhythmNet: a small recurrent network that follows music and says, of a moment kDelay_s ago,
// whether it was a beat, the half between two, or neither, and at which tempo dancers step. It
// remembers some bars, which tells what a stroke alone does not: a cumbia's beat from its rattles.
//
// Units/frames: one step for each RhythmFeatures; logarithms of likelihoods.
// Ownership:    the network is a plain value, some 200 kB, that many may share; each listener has a
//               RhythmState. step() allocates nothing.
// Threads:      none inside; const calls on states of their own may run at the same time.
// Failure:      none; states stay within ±1 whatever comes in.
// Source:       gated recurrent units: Cho et al., "Learning phrase representations using RNN
//               encoder-decoder", EMNLP 2014.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "producers/music/tracker/net/rhythm_features.h"

namespace dance {

// How much likelier what is heard is on a beat, or on the half after one, than elsewhere.
struct StrokeMeaning {
  float beat = 0.0f;
  float half = 0.0f;
};

// z = s(in_z + again_z), r = s(in_r + again_r), n = tanh(in_n + r * again_n),
// state = (1 - z) * n + z * state, with in = in * x + in_bias and again = again * state +
// again_bias; rows of z, r and n in this order.
struct RecurrentLayer {
  Eigen::MatrixXf in, again;
  Eigen::VectorXf in_bias, again_bias;
};

struct RhythmState;

struct RhythmNet {
  static constexpr int kInputs = static_cast<int>(RhythmFeatures::kCount);
  static constexpr int kLayers = 2;
  static constexpr int kUnits = 64;
  static constexpr int kMeanings = 3;  // beat, half, neither
  static constexpr int kTempi = 40;
  static constexpr int kAnswers = kMeanings + kTempi;
  static constexpr double kSlowest_bpm = 70.0;
  static constexpr double kFastest_bpm = 218.0;
  // The moment that an answer is about is this much before the end of the newest hop.
  static constexpr double kDelay_s = 0.19;

  std::array<RecurrentLayer, kLayers> layers;
  Eigen::MatrixXf out = Eigen::MatrixXf::Zero(kAnswers, kUnits);
  Eigen::VectorXf out_bias = Eigen::VectorXf::Zero(kAnswers);

  RhythmNet();

  // Place of a tempo among kTempi, between two of them too.
  static double place_of_tempo(double bpm);

  StrokeMeaning step(std::span<const float, RhythmFeatures::kCount> features,
                     RhythmState& state) const;
};

struct RhythmState {
  std::array<Eigen::VectorXf, RhythmNet::kLayers> units;
  Eigen::VectorXf in, again, answer;
  // Of each tempo, the logarithm of its probability.
  Eigen::VectorXf tempi;

  RhythmState();
};

}  // namespace dance

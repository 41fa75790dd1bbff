// Fits a network with one hidden layer to moments of known classes.
//
// Units/frames: a column of inputs for each moment; weights are relative.
// Ownership:    plain values.
// Threads:      none inside. The same moments and seed give the same network.
// Failure:      none; wants at least one moment.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "research/beats/music_training.h"

namespace dance {

struct NetMoments {
  Eigen::MatrixXf inputs;
  std::vector<std::uint8_t> classes;
  std::vector<float> weights;
};

struct NetSize {
  Eigen::Index inputs;
  Eigen::Index hidden;
  Eigen::Index answers;
};

// Answers = out * max(0, in * inputs + in_bias) + out_bias: logarithms of likelihoods.
struct FittedNet {
  Eigen::MatrixXf in, in_bias, out, out_bias;
};

FittedNet fit_net(const NetMoments& moments, const NetSize& size, const MusicTraining& training);

}  // namespace dance

// What trainers of recurrent networks share: where each parameter lies, how they are drawn, and the
// optimiser.
//
// Units/frames: parameters in one row, so that the optimiser has one loop; matrices are
//               inputs x outputs, by rows.
// Ownership:    plain values.
// Threads:      none inside; one owner.
// Failure:      a gradient that is not finite asserts.
// Source:       gated recurrent units (Cho et al., 2014); Adam (Kingma and Ba, 2015).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/assert.h"
#include "core/base/random.h"

namespace dance {

// `wide` numbers are rounded up to a multiple of 32, for matrix_product.h.
template <std::size_t kWideInputs, std::size_t kUnits, std::size_t kWideOutputs,
          std::size_t kLayers>
struct RecurrentPlaces {
  static constexpr std::size_t kGates = 3 * kUnits;

  struct Layer {
    std::size_t in, again, in_bias, again_bias;
  };
  std::array<Layer, kLayers> layers;
  std::size_t out, out_bias, count = 0;

  static constexpr std::size_t inputs(std::size_t layer) {
    return layer == 0 ? kWideInputs : kUnits;
  }

  RecurrentPlaces() {
    const auto take = [&](std::size_t n) {
      const std::size_t at = count;
      count += n;
      return at;
    };
    for (std::size_t l = 0; l < kLayers; ++l)
      layers[l] = {take(inputs(l) * kGates), take(kUnits * kGates), take(kGates), take(kGates)};
    out = take(kUnits * kWideOutputs);
    out_bias = take(kWideOutputs);
  }

  // Weights of a network that has learned nothing; biases are 0.
  std::vector<float> drawn(Random& random) const {
    std::vector<float> values(count);
    const auto draw = [&](std::size_t at, std::size_t n, double spread) {
      for (std::size_t i = 0; i < n; ++i)
        values[at + i] = static_cast<float>(spread * random.normal());
    };
    for (std::size_t l = 0; l < kLayers; ++l) {
      const std::size_t inner = inputs(l);
      draw(layers[l].in, inner * kGates, 1.0 / std::sqrt(static_cast<double>(inner)));
      draw(layers[l].again, kUnits * kGates, 1.0 / std::sqrt(static_cast<double>(kUnits)));
    }
    draw(out, kUnits * kWideOutputs, 0.05);
    return values;
  }

  template <class Net>
  Net net(const std::vector<float>& values) const {
    Net net;
    const auto matrix = [&](std::size_t at, std::size_t wide, Eigen::MatrixXf& to) {
      for (Eigen::Index i = 0; i < to.rows(); ++i)
        for (Eigen::Index j = 0; j < to.cols(); ++j)
          to(i, j) = values[at + static_cast<std::size_t>(j) * wide + static_cast<std::size_t>(i)];
    };
    const auto vector = [&](std::size_t at, Eigen::VectorXf& to) {
      for (Eigen::Index i = 0; i < to.size(); ++i) to[i] = values[at + static_cast<std::size_t>(i)];
    };
    for (std::size_t l = 0; l < kLayers; ++l) {
      matrix(layers[l].in, kGates, net.layers[l].in);
      matrix(layers[l].again, kGates, net.layers[l].again);
      vector(layers[l].in_bias, net.layers[l].in_bias);
      vector(layers[l].again_bias, net.layers[l].again_bias);
    }
    matrix(out, kWideOutputs, net.out);
    vector(out_bias, net.out_bias);
    return net;
  }
};

// Adam on a gradient whose length is bounded.
class ClippedAdam {
 public:
  explicit ClippedAdam(std::size_t parameters) : mean_(parameters), square_(parameters) {}

  void see(const std::vector<float>& gradient, double most_length) {
    double square = 0.0;
    for (const float g : gradient) square += static_cast<double>(g) * static_cast<double>(g);
    DANCE_ASSERT(std::isfinite(square));
    const auto shrink = static_cast<float>(std::min(1.0, most_length / (std::sqrt(square) + 1e-9)));
    ++steps_;
    mean_part_ = 1.0 - std::pow(0.9, steps_);
    square_part_ = 1.0 - std::pow(0.999, steps_);
    for (std::size_t i = 0; i < gradient.size(); ++i) {
      const float x = shrink * gradient[i];
      mean_[i] += 0.1f * (x - mean_[i]);
      square_[i] += 0.001f * (x * x - square_[i]);
    }
  }

  // A parameter goes by -rate * mean / spread.
  double mean(std::size_t i) const { return static_cast<double>(mean_[i]) / mean_part_; }
  double spread(std::size_t i) const {
    return std::sqrt(static_cast<double>(square_[i]) / square_part_) + 1e-8;
  }
  int steps() const { return steps_; }

 private:
  std::vector<float> mean_, square_;
  double mean_part_ = 1.0, square_part_ = 1.0;
  int steps_ = 0;
};

}  // namespace dance

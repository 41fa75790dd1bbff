// Recursive least squares with forgetting: a linear predictor whose weights are solved anew after
// each sample. The same bits on every machine: made of + − × ÷ and √ only, in a fixed order.
//
// Units/frames: those of the samples.
// Ownership:    plain values, no heap.
// Threads:      none inside.
// Failure:      weights stay as they were where the samples determine none; bounded samples give
//               finite weights.
// Source:       (C + ridge) (w − prior) = Σ x (y − xᵀ prior) by Cholesky's decomposition.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace dance {

template <std::size_t kInputs>
class LeastSquares {
 public:
  using Inputs = std::array<double, kInputs>;

  explicit LeastSquares(const Inputs& prior) : prior_(prior), weights_(prior) {}

  const Inputs& weights() const { return weights_; }
  double predict(const Inputs& x) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < kInputs; ++i) sum += weights_[i] * x[i];
    return sum;
  }
  void learn(const Inputs& x, double y) {
    double missed = y;
    for (std::size_t i = 0; i < kInputs; ++i) missed -= prior_[i] * x[i];
    for (std::size_t i = 0; i < kInputs; ++i) {
      for (std::size_t j = 0; j <= i; ++j) squares_[i][j] = kForget * squares_[i][j] + x[i] * x[j];
      products_[i] = kForget * products_[i] + missed * x[i];
    }
    solve();
  }

 private:
  static constexpr double kForget = 0.997;
  // Regularises weights of inputs that are nearly constant or collinear.
  static constexpr double kRidge = 1e-5;
  static constexpr double kLeastRidge = 1e-16;

  void solve() {
    std::array<Inputs, kInputs> l;
    double trace = 0.0;
    for (std::size_t i = 0; i < kInputs; ++i) trace += squares_[i][i];
    for (std::size_t i = 0; i < kInputs; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        double s = squares_[i][j];
        if (i == j) s += kRidge * squares_[i][i] + 1e-3 * kRidge * trace + kLeastRidge;
        for (std::size_t k = 0; k < j; ++k) s -= l[i][k] * l[j][k];
        if (i != j) {
          l[i][j] = s / l[j][j];
        } else {
          if (!(s > 0.0)) return;
          l[i][i] = std::sqrt(s);
        }
      }
    }
    Inputs z;
    for (std::size_t i = 0; i < kInputs; ++i) {
      double s = products_[i];
      for (std::size_t k = 0; k < i; ++k) s -= l[i][k] * z[k];
      z[i] = s / l[i][i];
    }
    for (std::size_t i = kInputs; i-- > 0;) {
      double s = z[i];
      for (std::size_t k = i + 1; k < kInputs; ++k) s -= l[k][i] * z[k];
      z[i] = s / l[i][i];
      weights_[i] = prior_[i] + z[i];
    }
  }

  Inputs prior_;
  Inputs weights_;
  std::array<Inputs, kInputs> squares_{};  // the lower half
  Inputs products_{};
};

}  // namespace dance

#include <algorithm>
#include <cmath>

#include "research/codec/codec_training.h"

namespace dance {
namespace {

constexpr std::size_t kRow = kSpreadFeatures + 1;
constexpr std::size_t kMostRows = 6000;  // in each step of the descent
constexpr int kSteps = 100;
// The codec's own distribution: logistic, 15 % of it three times as wide.
constexpr std::array<std::pair<double, double>, 2> kMixture{{{0.85, 1.0}, {0.15, 3.0}}};

double logistic(double z) { return z > 30.0 ? 1.0 : z < -30.0 ? 0.0 : 1.0 / (1.0 + std::exp(-z)); }

// d(−ln P)/d(log2 s) of a residual within ±½ of r, under the distribution of spread s.
double slope_of(double r, double log2_s) {
  const double s = std::exp2(std::clamp(log2_s, -4.0, 12.0));
  double p = 1e-5, dp = 0.0;
  for (const auto& [share, wide] : kMixture) {
    const double high = (r + 0.5) / (wide * s), low = (r - 0.5) / (wide * s);
    const double F_high = logistic(high), F_low = logistic(low);
    p += share * (F_high - F_low);
    dp += share * (low * F_low * (1.0 - F_low) - high * F_high * (1.0 - F_high));
  }
  return std::clamp(-dp / p * std::log(2.0), -5.0, 5.0);
}

using Numbers = std::array<double, kSpreadFeatures>;

}  // namespace

// Adam on standardised features.
void fit_spread(std::array<float, kSpreadFeatures>& weights, const std::vector<float>& rows) {
  const std::size_t count = rows.size() / kRow;
  if (count < 100) return;
  Numbers mean{}, sd{}, u{}, first{}, second{};
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < kSpreadFeatures; ++k) {
      const double x = static_cast<double>(rows[i * kRow + k]);
      mean[k] += x / static_cast<double>(count);
      sd[k] += x * x / static_cast<double>(count);
    }
  for (std::size_t k = 1; k < kSpreadFeatures; ++k)
    sd[k] = std::sqrt(std::max(sd[k] - mean[k] * mean[k], 0.0));
  const auto is_used = [&](std::size_t k) { return k > 0 && sd[k] > 0.02; };
  u[0] = static_cast<double>(weights[0]);
  for (std::size_t k = 1; k < kSpreadFeatures; ++k) {
    const double w = static_cast<double>(weights[k]);
    u[k] = is_used(k) ? w * sd[k] : 0.0;
    u[0] += w * mean[k];
  }
  const std::size_t stride = std::max<std::size_t>(1, count / kMostRows);
  for (int step = 1; step <= kSteps; ++step) {
    Numbers slope{};
    std::size_t used = 0;
    for (std::size_t i = static_cast<std::size_t>(step) % stride; i < count; i += stride, ++used) {
      Numbers x{};
      x[0] = 1.0;
      double log2_s = u[0];
      for (std::size_t k = 1; k < kSpreadFeatures; ++k) {
        if (!is_used(k)) continue;
        x[k] = (static_cast<double>(rows[i * kRow + k]) - mean[k]) / sd[k];
        log2_s += u[k] * x[k];
      }
      const double s = slope_of(static_cast<double>(rows[i * kRow + kSpreadFeatures]), log2_s);
      for (std::size_t k = 0; k < kSpreadFeatures; ++k) slope[k] += s * x[k];
    }
    const double rate = 0.15 * (1.0 - 0.9 * step / kSteps);
    for (std::size_t k = 0; k < kSpreadFeatures; ++k) {
      const double g = slope[k] / static_cast<double>(used) + (k > 0 ? 2e-4 * u[k] : 0.0);
      first[k] = 0.9 * first[k] + 0.1 * g;
      second[k] = 0.99 * second[k] + 0.01 * g * g;
      u[k] -= rate * (first[k] / (1.0 - std::pow(0.9, step))) /
              (std::sqrt(second[k] / (1.0 - std::pow(0.99, step))) + 1e-6);
    }
  }
  double base = u[0];
  for (std::size_t k = 1; k < kSpreadFeatures; ++k) {
    const double w = is_used(k) ? u[k] / sd[k] : 0.0;
    weights[k] = static_cast<float>(w);
    base -= w * mean[k];
  }
  weights[0] = static_cast<float>(base);
}

}  // namespace dance

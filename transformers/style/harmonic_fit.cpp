#include "transformers/style/harmonic_fit.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

namespace dance {
namespace {

// In seconds of dance, of the five or so that are remembered: a few parts in a thousand too little.
constexpr double kRidge_s = 0.01;

}  // namespace

void HarmonicFit::forget() {
  gram_.setZero();
  for (auto& row : moment_) row.fill(0.0f);
  seen_s_ = 0.0;
}

HarmonicFit::Terms HarmonicFit::terms_at(double bars) {
  Terms terms;
  terms[0] = 1.0;
  int next = 1;
  for (const double harmonic : kHarmonics) {
    const double turns = harmonic * bars;
    const double angle = 2.0 * std::numbers::pi * (turns - std::floor(turns));
    terms[next++] = std::cos(angle);
    terms[next++] = std::sin(angle);
  }
  return terms;
}

void HarmonicFit::add(double bars, double dt_s, double memory_s, const Channels& channels) {
  const double kept = std::exp(-dt_s / memory_s);
  const Terms terms = terms_at(bars);
  gram_ = kept * gram_ + dt_s * (terms * terms.transpose());
  for (std::size_t t = 0; t < static_cast<std::size_t>(kTerms); ++t) {
    const auto fading = static_cast<float>(kept);
    const auto weight = static_cast<float>(dt_s * terms[static_cast<int>(t)]);
    for (std::size_t c = 0; c < kChannels; ++c)
      moment_[t][c] = fading * moment_[t][c] + weight * channels[c];
  }
  seen_s_ += dt_s;
}

void HarmonicFit::periodic_at(double bars, Channels& out) const {
  // p(t) = φ(t)ᵀ (G + εI)⁻¹ b: one solution serves all channels. The constant term is fitted and
  // left out.
  Terms terms = terms_at(bars);
  terms[0] = 0.0;
  Eigen::Matrix<double, kTerms, kTerms> system = gram_;
  system.diagonal().array() += kRidge_s;
  const Terms weights = system.llt().solve(terms);
  out.fill(0.0f);
  for (std::size_t t = 0; t < static_cast<std::size_t>(kTerms); ++t) {
    const auto weight = static_cast<float>(weights[static_cast<int>(t)]);
    for (std::size_t c = 0; c < kChannels; ++c) out[c] += weight * moment_[t][c];
  }
}

}  // namespace dance

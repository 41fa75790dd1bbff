#include "producers/camera/stereo/depth_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace dance {
namespace {

// The network's own error of a point's depth relative to the hips: it grows with the way from
// there.
double network_spread_m(const Eigen::Vector3d& p_m) {
  constexpr double kAtHips_m = 0.02;
  constexpr double kPerMetre = 0.1;
  return std::hypot(kAtHips_m, kPerMetre * p_m.norm());
}

// What bodies and clothes differ by from kLimbPlaces and the torso's ellipse: common to all joints,
// so that more of them do not make it less.
constexpr double kSkin_m = 0.02;
// Of all disparities alike, what a good calibration leaves.
constexpr double kCalibration_px = 0.2;
// Samples of one limb or torso share joints: two of them count as one.
constexpr double kSamplesPerJoint = 2.0;

struct Weighed {
  double value;
  double weight;
};

double weighted_median(std::span<Weighed> all) {
  std::sort(all.begin(), all.end(),
            [](const Weighed& a, const Weighed& b) { return a.value < b.value; });
  double total = 0.0;
  for (const Weighed& one : all) total += one.weight;
  double sum = 0.0;
  for (const Weighed& one : all) {
    sum += one.weight;
    if (sum >= 0.5 * total) return one.value;
  }
  return all.empty() ? 0.0 : all.back().value;
}

struct RobustMean {
  double value = 0.0;
  double spread = 0.0;
  int joints = 0;
};

// Tukey's biweight about the weighted median; the scale is the median deviation, and never below
// that of a good match.
RobustMean robust_mean(std::span<const Weighed> all) {
  constexpr int kSteps = 8;
  constexpr double kLeastScale_m = 0.03;
  std::array<Weighed, kMostBodySamples> work;
  const std::span<Weighed> copy(work.data(), all.size());
  std::copy(all.begin(), all.end(), copy.begin());
  RobustMean out;
  out.value = weighted_median(copy);
  for (std::size_t i = 0; i < all.size(); ++i)
    copy[i] = {std::abs(all[i].value - out.value), all[i].weight};
  const double reach = 4.685 * std::max(1.4826 * weighted_median(copy), kLeastScale_m);
  for (int step = 0; step < kSteps; ++step) {
    double sum = 0.0;
    double weights = 0.0;
    double squares = 0.0;
    double weight_squares = 0.0;
    out.joints = 0;
    for (const Weighed& one : all) {
      const double x = (one.value - out.value) / reach;
      const double kept = std::abs(x) < 1.0 ? (1.0 - x * x) * (1.0 - x * x) : 0.0;
      const double weight = one.weight * kept;
      sum += weight * one.value;
      weights += weight;
      weight_squares += weight * weight;
      squares += weight * (one.value - out.value) * (one.value - out.value);
      out.joints += kept > 0.3 ? 1 : 0;
    }
    if (!(weights > 0.0)) return {};
    out.value = sum / weights;
    const double count = std::max(1.0, weights * weights / weight_squares / kSamplesPerJoint);
    out.spread = std::sqrt(squares / weights / count);
  }
  return out;
}

}  // namespace

// Per sample  tx − a·tz = a·Z − X,  ty − e·tz = e·Z − Y  with the ray (a, e, 1).
std::optional<MonocularFit> fit_monocular(const BodySamples& samples) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double squares = 0.0;
  int rows = 0;
  for (const BodySample& sample : samples) {
    for (int axis = 0; axis < 2; ++axis) {
      Eigen::Vector3d row = Eigen::Vector3d::Zero();
      row(axis) = 1.0;
      row.z() = -sample.straight(axis);
      const double value = sample.straight(axis) * sample.p_m.z() - sample.p_m(axis);
      normal += sample.weight * row * row.transpose();
      right += sample.weight * value * row;
      squares += sample.weight * value * value;
      ++rows;
    }
  }
  // Four samples, well apart.
  if (rows < 8) return std::nullopt;
  const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
  if (solver.info() != Eigen::Success || !(solver.vectorD().minCoeff() > 1e-6)) return std::nullopt;
  MonocularFit fit;
  fit.p_CH_m = solver.solve(right);
  if (!fit.p_CH_m.allFinite() || fit.p_CH_m.z() < 0.2 || fit.p_CH_m.z() > 50.0) return std::nullopt;
  const double left_over = std::max(0.0, squares - right.dot(fit.p_CH_m));
  const double variance = left_over / (rows - 3) * kSamplesPerJoint;
  fit.depth_spread_m = std::sqrt(variance * solver.solve(Eigen::Vector3d::UnitZ()).z());
  return fit;
}

std::optional<DepthHint> fit_depth(const BodySamples& samples, std::span<const SampleDepth> depths,
                                   const MonocularFit& one_eye, double focal_baseline_px_m) {
  if (depths.size() < static_cast<std::size_t>(kLeastJoints) || depths.size() > kMostBodySamples)
    return std::nullopt;
  const double one_eye_m = one_eye.p_CH_m.z();
  DepthHint hint;
  RobustMean mean;
  // The joints' depths behind the hips grow with the scale, and the scale is known from the depth:
  // a few rounds settle both.
  for (int round = 0; round < 4; ++round) {
    std::array<Weighed, kMostBodySamples> hips;
    for (std::size_t i = 0; i < depths.size(); ++i) {
      const BodySample& sample = samples[depths[i].sample];
      const double network = hint.scale * network_spread_m(sample.p_m);
      const double variance = depths[i].spread_m * depths[i].spread_m + network * network;
      hips[i] = {depths[i].skin_depth_m + hint.scale * (sample.skin_m - sample.p_m.z()),
                 sample.weight / variance};
    }
    mean = robust_mean(std::span(hips.data(), depths.size()));
    if (mean.joints < kLeastJoints || !(mean.value > 0.1)) return std::nullopt;
    hint.scale = mean.value / one_eye_m;
  }
  hint.hips_depth_m = mean.value;
  const double calibration_m = mean.value * mean.value / focal_baseline_px_m * kCalibration_px;
  hint.spread_m = std::hypot(mean.spread, hint.scale * kSkin_m, calibration_m);
  hint.scale_spread = hint.scale * std::hypot(hint.spread_m / hint.hips_depth_m,
                                              one_eye.depth_spread_m / one_eye_m);
  hint.joints = mean.joints;
  return hint;
}

}  // namespace dance

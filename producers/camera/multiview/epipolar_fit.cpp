#include "producers/camera/multiview/epipolar_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/base/median.h"

namespace dance {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Step = RelativePose::Step;

namespace {

constexpr int kLeastMoments = 20;
// Residuals that are larger, in the spread of all, are down-weighted.
constexpr double kOutlier = 3.0;
// The first spread, while nothing fits yet.
constexpr double kFirstSpread = 20.0;
// Of the turn that the networks' metres give.
constexpr double kGivenTurnSd_rad = 0.06;
constexpr double kDamping = 1e-3;
constexpr double kMostTurn_rad = 0.25, kMostLaterStep_s = 0.03;
// So many residuals count as one: a network's errors last.
constexpr double kSame = 8.0;
// Of an absolute deviation's median.
constexpr double kOfMedian = 1.4826;
constexpr std::size_t kFewestPoints = 6;

struct Residual {
  double value;
  Step row;
};

// e = b · (t × y), y = R a: the volume that three vectors span that should lie in one plane, over
// its standard deviation.
bool residual_of(const RelativePose& pose, const Eigen::Matrix<double, 3, 2>& ways,
                 const ViewPoints& first, const ViewMoment& other, std::size_t i, Residual& out) {
  const auto weight = std::min(static_cast<double>(first.weight[i]), other.weight[i]);
  if (weight < 0.2) return false;
  const Vector3d y = pose.R_BA * first.ray[i].cast<double>().homogeneous();
  const Vector3d b = other.ray[i].homogeneous();
  const Vector3d line_B = pose.p_BA.cross(y), line_A = pose.R_BA.transpose() * b.cross(pose.p_BA);
  const double sd_A = static_cast<double>(first.ray_sd),
               sd_B = static_cast<double>(other.nearest->ray_sd);
  const double sd = std::sqrt((sd_B * sd_B * line_B.head<2>().squaredNorm() +
                               sd_A * sd_A * line_A.head<2>().squaredNorm()) /
                              weight);
  if (!(sd > 1e-12)) return false;
  out.value = b.dot(line_B) / sd;
  out.row.head<3>() = y.cross(b.cross(pose.p_BA)) / sd;
  out.row.segment<2>(3) = ways.transpose() * y.cross(b) / sd;
  out.row[5] = other.rate[i].dot(line_B.head<2>()) / sd;
  return true;
}

}  // namespace

void EpipolarFit::begin(const RelativePose& pose) {
  pose_ = pose;
  given_R_BA_ = pose.R_BA;
  spread_ = kFirstSpread;
  cost_ = 1e9;
  moments_ = 0;
  sd_.setConstant(1e3);
}

bool EpipolarFit::step(const KeyMoments& moments, const ViewHistory& other, bool frees_time) {
  using Normal = Eigen::Matrix<double, 6, 6>;
  Normal normal = Normal::Zero();
  Step gradient = Step::Zero();
  const Eigen::Matrix<double, 3, 2> ways = pose_.ways_of_baseline();
  const Duration later = Duration::seconds(pose_.later_s);
  const double outlier = kOutlier * std::max(1.0, spread_);
  ViewMoment b;
  Residual residual;
  std::size_t count = 0;
  double cost = 0.0;
  moments_ = 0;
  for (std::uint64_t m = moments.first(); m < moments.added(); ++m) {
    const ViewPoints& a = moments.entry(m);
    if (!other.at(a.time + later, b)) continue;
    ++moments_;
    for (std::size_t i = 0; i < kViewPointCount; ++i) {
      if (!residual_of(pose_, ways, a, b, i, residual)) continue;
      sizes_[count++] = static_cast<float>(std::abs(residual.value));
      const double squared = residual.value * residual.value;
      cost += std::log1p(squared / (kOutlier * kOutlier));
      const double weight = 1.0 / (1.0 + squared / (outlier * outlier));
      normal.selfadjointView<Eigen::Lower>().rankUpdate(residual.row, weight);
      gradient += weight * residual.value * residual.row;
    }
  }
  if (moments_ < kLeastMoments || count == 0) return false;
  normal = Normal(normal.selfadjointView<Eigen::Lower>());
  const double spread = kOfMedian * static_cast<double>(median_of(std::span(sizes_.data(), count)));
  // The residuals' own spread makes their weights.
  const double variance = std::max(1.0, spread * spread) * kSame;
  normal /= variance;
  gradient /= variance;
  const Eigen::AngleAxisd off(pose_.R_BA * given_R_BA_.transpose());
  const double given = 1.0 / (kGivenTurnSd_rad * kGivenTurnSd_rad);
  normal.topLeftCorner<3, 3>() += given * Matrix3d::Identity();
  gradient.head<3>() += given * off.angle() * off.axis();
  Normal damped = normal;
  damped.diagonal() *= 1.0 + kDamping;
  damped.diagonal().array() += 1e-9;
  if (!frees_time) {
    damped.row(5).setZero();
    damped.col(5).setZero();
    damped(5, 5) = 1.0;
    gradient[5] = 0.0;
  }
  Step step = -damped.ldlt().solve(gradient);
  if (!step.allFinite() || !std::isfinite(cost)) return false;
  step.head<5>() = step.head<5>().cwiseMax(-kMostTurn_rad).cwiseMin(kMostTurn_rad);
  step[5] = std::clamp(step[5], -kMostLaterStep_s, kMostLaterStep_s);
  spread_ = spread;
  cost_ = cost / static_cast<double>(count);
  if (frees_time)
    sd_ = (normal + 1e-9 * Normal::Identity()).inverse().diagonal().cwiseMax(0.0).cwiseSqrt();
  pose_ = pose_.moved(step);
  return true;
}

double spread_of_moment(const RelativePose& pose, const ViewPoints& first,
                        const ViewHistory& other) {
  ViewMoment b;
  if (!other.at(first.time + Duration::seconds(pose.later_s), b)) return -1.0;
  const Eigen::Matrix<double, 3, 2> ways = pose.ways_of_baseline();
  std::array<float, kViewPointCount> sizes;
  std::size_t count = 0;
  Residual residual;
  for (std::size_t i = 0; i < kViewPointCount; ++i)
    if (residual_of(pose, ways, first, b, i, residual))
      sizes[count++] = static_cast<float>(std::abs(residual.value));
  if (count < kFewestPoints) return -1.0;
  return kOfMedian * static_cast<double>(median_of(std::span(sizes.data(), count)));
}

}  // namespace dance

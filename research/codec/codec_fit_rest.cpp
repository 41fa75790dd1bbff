#include <Eigen/Dense>
#include <cmath>

#include "core/codec/lattice/body_quantiser.h"
#include "research/codec/codec_training.h"

namespace dance {
namespace {

// Where on the floor somebody stands, and where he faces, tells nothing of his body.
bool is_whereabouts(std::size_t c) { return c == 0 || c == 2 || c == 5; }
constexpr double kFloorSpread_m = 0.8;
constexpr double kHeadingSpread_rad = 1.2;
// Mean absolute value of a logistic distribution of spread 1.
constexpr double kMeanOfLogistic = 1.386;
// Other dancers than those trained on are a little further off.
constexpr double kMargin_log2 = 0.2;

using Rows = Eigen::Matrix<double, Eigen::Dynamic, static_cast<int>(kCoordinateCount)>;

Rows coordinates_of(const std::vector<TakeLattice>& takes) {
  std::vector<std::array<double, kCoordinateCount>> all;
  for (const TakeLattice& t : takes)
    for (std::size_t i = 0; i < t.take->poses.size(); i += 3) {
      const TrueBody body = true_body(*t.lattice, t.take->poses[i]);
      std::array<double, kCoordinateCount> x{
          body.joint[0].x, body.joint[0].y - t.lattice->offset(0).y, body.joint[0].z};
      for (std::size_t b = 0; b < kBoneCount; ++b) {
        const exact::SwingTwist a = t.lattice->angles_of(b, body.local[b]);
        const std::size_t c = first_coordinate(b);
        x[c] = a.u, x[c + 1] = a.v, x[c + 2] = a.w;
      }
      all.push_back(x);
    }
  Rows rows(static_cast<Eigen::Index>(all.size()), static_cast<Eigen::Index>(kCoordinateCount));
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t c = 0; c < kCoordinateCount; ++c)
      rows(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) = all[i][c];
  return rows;
}

// Ridge regression on the chosen coordinates; what of the variance is left.
double regress(const Eigen::MatrixXd& cov, Eigen::Index c, const std::vector<Eigen::Index>& from,
               Eigen::VectorXd& weights) {
  const auto n = static_cast<Eigen::Index>(from.size());
  Eigen::MatrixXd A(n, n);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index fi = from[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k < n; ++k) A(i, k) = cov(fi, from[static_cast<std::size_t>(k)]);
    A(i, i) += 0.02 * cov(fi, fi) + 1e-6;
    b[i] = cov(fi, c);
  }
  weights = A.ldlt().solve(b);
  return cov(c, c) - weights.dot(b);
}

}  // namespace

RestModel find_rest(const std::vector<CodecTake>& takes) {
  RestModel rest;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    Eigen::Matrix4d around = Eigen::Matrix4d::Zero();
    for (const CodecTake& take : takes)
      for (const Pose& pose : take.poses) {
        const Eigen::Vector4d q = pose.R_PB[b].coeffs().cast<double>();
        around += q * q.transpose();
      }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> mean(around);
    Eigen::Quaterniond centre;
    centre.coeffs() = mean.eigenvectors().col(3);
    if (centre.w() < 0.0) centre.coeffs() *= -1.0;
    Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();
    for (const CodecTake& take : takes)
      for (const Pose& pose : take.poses) {
        Eigen::Quaterniond d = centre.conjugate() * pose.R_PB[b].cast<double>();
        if (d.w() < 0.0) d.coeffs() *= -1.0;
        const Eigen::AngleAxisd turn(d);
        const Eigen::Vector3d v = turn.angle() * turn.axis();
        turns += v * v.transpose();
      }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(turns);
    const Eigen::Vector3d hinge = axes.eigenvectors().col(2);
    for (int i = 0; i < 4; ++i)
      rest.bones[b].centre_xyzw[static_cast<std::size_t>(i)] =
          from_half(to_half(static_cast<float>(centre.coeffs()[i])));
    for (int i = 0; i < 3; ++i)
      rest.bones[b].hinge[static_cast<std::size_t>(i)] =
          from_half(to_half(static_cast<float>(hinge[i])));
  }
  return rest;
}

std::array<IntraModel, kCoordinateCount> find_intra(const std::vector<TakeLattice>& takes) {
  Rows rows = coordinates_of(takes);
  const Eigen::RowVectorXd mean = rows.colwise().mean();
  rows.rowwise() -= mean;
  const Eigen::MatrixXd cov = rows.transpose() * rows / static_cast<double>(rows.rows());
  std::array<IntraModel, kCoordinateCount> coordinates;
  for (std::size_t c = 0; c < kCoordinateCount; ++c) {
    IntraModel& coordinate = coordinates[c];
    if (is_whereabouts(c)) {
      coordinate.spread_log2 =
          static_cast<float>(std::log2(c == 5 ? kHeadingSpread_rad : kFloorSpread_m));
      continue;
    }
    const auto column = static_cast<Eigen::Index>(c);
    std::vector<Eigen::Index> from;
    Eigen::VectorXd weights;
    double left = cov(column, column);
    while (from.size() < kIntraTerms) {  // whichever helps most, one after the other
      Eigen::Index best = -1;
      double best_left = left * 0.985;
      for (std::size_t j = 0; j < c; ++j) {
        if (is_whereabouts(j)) continue;
        std::vector<Eigen::Index> with = from;
        with.push_back(static_cast<Eigen::Index>(j));
        Eigen::VectorXd w;
        const double l = regress(cov, column, with, w);
        if (l < best_left) best_left = l, best = static_cast<Eigen::Index>(j);
      }
      if (best < 0) break;
      from.push_back(best);
      left = regress(cov, column, from, weights);
    }
    double base = mean[column];
    Eigen::VectorXd residual = rows.col(column);
    for (std::size_t i = 0; i < from.size(); ++i) {
      const double w = weights[static_cast<Eigen::Index>(i)];
      coordinate.from[i] = static_cast<std::uint8_t>(from[i]);
      coordinate.weight[i] = static_cast<float>(w);
      base -= w * mean[from[i]];
      residual -= w * rows.col(from[i]);
    }
    coordinate.base = static_cast<float>(base);
    const double size = residual.cwiseAbs().mean() / kMeanOfLogistic;
    coordinate.spread_log2 = static_cast<float>(std::log2(std::max(size, 1e-5)) + kMargin_log2);
  }
  return coordinates;
}

}  // namespace dance

#include "producers/camera/multiview/view_alignment.h"

#include <Eigen/SVD>
#include <algorithm>
#include <array>

#include "core/base/median.h"

namespace dance {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr int kFewestAligned = 20;
constexpr int kRounds = 3;
// A moment whose directions differ by more between the cameras, in radians, counts little: one of
// the networks took a back for a front.
constexpr double kSurprise = 0.4;

struct Direction {
  std::size_t from_a, from_b, to_a, to_b;
  double weight;
};
constexpr Direction between_points(Landmark from, Landmark to, double weight) {
  return {view_point_of(from), view_point_of(from), view_point_of(to), view_point_of(to), weight};
}
constexpr std::array kDirections{
    Direction{view_point_of(Landmark::kLeftHip), view_point_of(Landmark::kRightHip),
              view_point_of(Landmark::kLeftShoulder), view_point_of(Landmark::kRightShoulder), 2.0},
    between_points(Landmark::kRightHip, Landmark::kLeftHip, 0.5),
    between_points(Landmark::kRightShoulder, Landmark::kLeftShoulder, 0.5),
    between_points(Landmark::kLeftShoulder, Landmark::kLeftElbow, 1.0),
    between_points(Landmark::kRightShoulder, Landmark::kRightElbow, 1.0),
    between_points(Landmark::kLeftElbow, Landmark::kLeftWrist, 1.0),
    between_points(Landmark::kRightElbow, Landmark::kRightWrist, 1.0),
    between_points(Landmark::kLeftHip, Landmark::kLeftKnee, 1.0),
    between_points(Landmark::kRightHip, Landmark::kRightKnee, 1.0),
    between_points(Landmark::kLeftKnee, Landmark::kLeftAnkle, 1.0),
    between_points(Landmark::kRightKnee, Landmark::kRightAnkle, 1.0)};

// The outer products of one moment's directions, B's with A's; how far they differ from a turn.
struct Products {
  Matrix3d sum = Matrix3d::Zero();
  double weight = 0.0;
  double off = 0.0;
};

Products products_of(const ViewPoints& a, const ViewPoints& b, const Matrix3d& R_BA) {
  Products products;
  for (const Direction& d : kDirections) {
    const auto weight =
        d.weight *
        static_cast<double>(
            std::min({a.weight[d.from_a], a.weight[d.from_b], a.weight[d.to_a], a.weight[d.to_b],
                      b.weight[d.from_a], b.weight[d.from_b], b.weight[d.to_a], b.weight[d.to_b]}));
    if (weight <= 0.0) continue;
    const auto of = [&d](const ViewPoints& p) {
      return Vector3d(
          (p.world_m[d.to_a] + p.world_m[d.to_b] - p.world_m[d.from_a] - p.world_m[d.from_b])
              .cast<double>()
              .normalized());
    };
    const Vector3d in_A = of(a), in_B = of(b);
    products.sum += weight * in_B * in_A.transpose();
    products.off += weight * (in_B - R_BA * in_A).norm();
    products.weight += weight;
  }
  if (products.weight > 0.0) products.off /= products.weight;
  return products;
}

Matrix3d nearest_turn(const Matrix3d& sum) {
  const Eigen::JacobiSVD<Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d flip = Matrix3d::Identity();
  flip(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return svd.matrixU() * flip * svd.matrixV().transpose();
}

}  // namespace

bool align_views(const KeyMoments& moments, const ViewHistory& other, RelativePose& out) {
  const Duration later = Duration::seconds(out.later_s);
  ViewMoment b;
  int seen = 0;
  for (int round = 0; round < kRounds; ++round) {
    Matrix3d sum = Matrix3d::Zero();
    seen = 0;
    for (std::uint64_t m = moments.first(); m < moments.added(); ++m) {
      const ViewPoints& a = moments.entry(m);
      if (!other.at(a.time + later, b)) continue;
      const Products products = products_of(a, *b.nearest, out.R_BA);
      if (!(products.weight > 0.0)) continue;
      ++seen;
      const double off = round == 0 ? 0.0 : products.off / kSurprise;
      sum += products.sum / (1.0 + off * off * off * off);
    }
    if (seen < kFewestAligned || !sum.allFinite()) return false;
    out.R_BA = nearest_turn(sum);
  }
  std::array<std::array<float, KeyMoments::kCapacity>, 3> ways{};
  std::size_t count = 0;
  for (std::uint64_t m = moments.first(); m < moments.added(); ++m) {
    const ViewPoints& a = moments.entry(m);
    if (!(a.distance_m > 0.0f) || !other.at(a.time + later, b) || !(b.nearest->distance_m > 0.0f))
      continue;
    const Eigen::Vector3f way = b.nearest->hips_m - out.R_BA.cast<float>() * a.hips_m;
    for (int axis = 0; axis < 3; ++axis) ways[static_cast<std::size_t>(axis)][count] = way[axis];
    ++count;
  }
  if (count < kFewestAligned) return false;
  Vector3d way;
  for (int axis = 0; axis < 3; ++axis)
    way[axis] = static_cast<double>(
        median_of(std::span(ways[static_cast<std::size_t>(axis)].data(), count)));
  if (!(way.norm() > 1e-3)) return false;
  out.p_BA = way.normalized();
  return true;
}

}  // namespace dance

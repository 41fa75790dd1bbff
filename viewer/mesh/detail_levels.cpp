#include "viewer/mesh/detail_levels.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace dance {
namespace {

using Eigen::Vector3f;

// Triangles of a whole figure; a level is worth it where it has a good deal fewer than the finer
// one.
constexpr std::array<double, 5> kTargets{16000.0, 6000.0, 2500.0, 1200.0, 750.0};
constexpr double kWorthIt = 0.75;
// How far, as a share of the figure, a surface may come off its place; a coarser level than this
// allows is made by meshopt_simplifySloppy(), which does not keep holes and seams.
constexpr float kMostError = 0.04f;
constexpr float kMostSloppyError = 0.2f;
constexpr double kTooFarFromTarget = 2.5;
// Where two joints share the skin it is lifted off for the simplification only: a straight knee
// then looks bent to it, and keeps the rings of vertices that it bends by.
constexpr float kLiftOfBends_m = 0.018f;
// The simplification enlarges the head by this factor, so that faces keep more triangles.
constexpr float kHeadScale = 1.6f;

std::size_t triangle_count(const BatchTriangles& batches) {
  std::size_t indices = 0;
  for (const auto& batch : batches) indices += batch.size();
  return indices / 3;
}

class Simplifier {
 public:
  Simplifier(std::span<const DetailVertex> vertices, const BatchTriangles& fine)
      : place_of_(vertices.size()) {
    find_places(vertices);
    find_borders(fine);
    lift_bends(vertices);
  }

  BatchTriangles simplify(const BatchTriangles& finer, double target) const {
    const auto whole = static_cast<double>(triangle_count(finer));
    BatchTriangles coarser;
    for (std::size_t b = 0; b < finer.size(); ++b) {
      const double share = static_cast<double>(finer[b].size() / 3) / whole;
      const auto wanted = 3 * static_cast<std::size_t>(std::max(4.0, target * share));
      coarser.push_back(simplify_batch(finer[b], wanted, options_[b]));
    }
    return coarser;
  }

 private:
  // Vertices that differ in uv or normal only lie in one place.
  void find_places(std::span<const DetailVertex> vertices) {
    places_m_.reserve(vertices.size());
    Vector3f head = Vector3f::Zero();
    float weight = 0.0f;
    for (const DetailVertex& vertex : vertices) {
      head += vertex.face * vertex.place_m;
      weight += vertex.face;
    }
    if (weight > 0.0f) head /= weight;
    for (const DetailVertex& vertex : vertices)
      places_m_.push_back(vertex.place_m +
                          (kHeadScale - 1.0f) * vertex.face * (vertex.place_m - head));
    place_count_ = meshopt_generateVertexRemap(place_of_.data(), nullptr, vertices.size(),
                                               places_m_.data(), vertices.size(), sizeof(Vector3f));
  }

  // Where a batch meets another it must not move, or the figure would have gaps.
  void find_borders(const BatchTriangles& fine) {
    constexpr std::uint32_t kNobody = ~0u;
    std::vector<std::uint32_t> owner(place_count_, kNobody);
    options_.assign(fine.size(), 0);
    for (std::uint32_t b = 0; b < fine.size(); ++b)
      for (const std::uint32_t vertex : fine[b]) {
        std::uint32_t& by = owner[place_of_[vertex]];
        if (by == kNobody) by = b;
        if (by != b) options_[b] = options_[by] = meshopt_SimplifyLockBorder;
      }
  }

  // By one normal for all vertices of a place, or seams would open.
  void lift_bends(std::span<const DetailVertex> vertices) {
    std::vector<Vector3f> lift(place_count_, Vector3f::Zero());
    for (std::size_t v = 0; v < vertices.size(); ++v) lift[place_of_[v]] += vertices[v].normal;
    std::vector<float> bend(place_count_, 0.0f);
    for (std::size_t v = 0; v < vertices.size(); ++v)
      bend[place_of_[v]] = std::max(bend[place_of_[v]], vertices[v].bend);
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const Vector3f& normal = lift[place_of_[v]];
      if (normal.squaredNorm() > 1e-6f)
        places_m_[v] += kLiftOfBends_m * bend[place_of_[v]] * normal.normalized();
    }
  }

  std::vector<std::uint32_t> simplify_batch(const std::vector<std::uint32_t>& fine,
                                            std::size_t wanted, unsigned options) const {
    if (fine.size() <= wanted) return fine;
    const float* places = places_m_.front().data();
    std::vector<std::uint32_t> coarse(fine.size());
    coarse.resize(meshopt_simplify(coarse.data(), fine.data(), fine.size(), places,
                                   places_m_.size(), sizeof(Vector3f), wanted, kMostError, options,
                                   nullptr));
    if (static_cast<double>(coarse.size()) < kTooFarFromTarget * static_cast<double>(wanted))
      return coarse;
    std::vector<std::uint32_t> sloppy(fine.size());
    sloppy.resize(meshopt_simplifySloppy(sloppy.data(), fine.data(), fine.size(), places,
                                         places_m_.size(), sizeof(Vector3f), wanted,
                                         kMostSloppyError, nullptr));
    return sloppy.empty() ? coarse : sloppy;
  }

  std::vector<Vector3f> places_m_;
  std::vector<std::uint32_t> place_of_;
  std::size_t place_count_ = 0;
  std::vector<unsigned> options_;  // of each batch
};

void order_for_drawing(BatchTriangles& batches, std::size_t vertex_count) {
  for (auto& batch : batches)
    meshopt_optimizeVertexCache(batch.data(), batch.data(), batch.size(), vertex_count);
}

}  // namespace

std::vector<BatchTriangles> detail_levels(std::span<const DetailVertex> vertices,
                                          const BatchTriangles& fine) {
  std::vector<BatchTriangles> levels{fine};
  if (vertices.empty() || triangle_count(fine) == 0) return levels;
  const Simplifier simplifier(vertices, fine);
  for (const double target : kTargets) {
    const auto finer = static_cast<double>(triangle_count(levels.back()));
    if (target > kWorthIt * finer) continue;
    BatchTriangles coarser = simplifier.simplify(levels.back(), target);
    const auto reached = static_cast<double>(triangle_count(coarser));
    if (reached > 0.0 && reached <= kWorthIt * finer) levels.push_back(std::move(coarser));
  }
  for (BatchTriangles& level : levels) order_for_drawing(level, vertices.size());
  return levels;
}

}  // namespace dance

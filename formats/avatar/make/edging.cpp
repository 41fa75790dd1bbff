#include "formats/avatar/make/edging.h"

#include <cmath>

#include "formats/body/implicit_surface.h"

namespace dance {

using Eigen::Vector3f;

namespace {

constexpr int kEdgeHalvings = 13;
constexpr float kFurthestEdge_m = 0.2f;

float radius_m(const FigureLayer& layer, const Vector3f& axis_m, const Vector3f& direction) {
  if (signed_distance_m(layer, axis_m) > 0.0f) return 0.0f;
  float inside_m = 0.0f;
  float outside_m = kFurthestEdge_m;
  for (int i = 0; i < kEdgeHalvings; ++i) {
    const float r = 0.5f * (inside_m + outside_m);
    (signed_distance_m(layer, axis_m + r * direction) < 0.0f ? inside_m : outside_m) = r;
  }
  return inside_m;
}

// Where the cloth goes below the skin.
Vector3f edge_m(const Opening& opening, const Vector3f& direction) {
  float covered = 0.0f;
  float bare = 1.0f;
  const auto axis_m = [&](float share) -> Vector3f {
    return opening.begin_m + share * (opening.end_m - opening.begin_m);
  };
  for (int i = 0; i < kEdgeHalvings; ++i) {
    const float share = 0.5f * (covered + bare);
    const bool is_covered = radius_m(opening.cloth, axis_m(share), direction) >
                            radius_m(opening.skin, axis_m(share), direction);
    (is_covered ? covered : bare) = share;
  }
  return axis_m(bare) + radius_m(opening.skin, axis_m(bare), direction) * direction;
}

}  // namespace

Sheet edging(const Opening& opening, float tube_m, const SkinWeighting& weighting) {
  constexpr int kTurns = 22;
  constexpr int kSides = 5;
  const Vector3f along = (opening.end_m - opening.begin_m).normalized();
  const Vector3f first = along.unitOrthogonal();
  const Vector3f second = along.cross(first);
  Sheet sheet;
  for (int turn = 0; turn < kTurns; ++turn) {
    const float angle = kTwoPi * static_cast<float>(turn) / kTurns;
    const Vector3f direction = std::cos(angle) * first + std::sin(angle) * second;
    const Vector3f middle_m = edge_m(opening, direction);
    const SkinWeights skin = weighting.weights_at(middle_m, opening.cloth);
    for (int side = 0; side < kSides; ++side) {
      const float around = kTwoPi * static_cast<float>(side) / kSides;
      const Vector3f out = std::cos(around) * direction + std::sin(around) * along;
      AvatarVertex vertex = vertex_at(middle_m + tube_m * out);
      vertex.normal = out;
      for (std::size_t k = 0; k < 4; ++k) vertex.joints[k] = skin.joints[k];
      vertex.weights = skin.weights;
      sheet.vertices.push_back(vertex);
    }
  }
  join_rows(sheet, 0, kTurns, kSides, RowEnds::kJoined);
  // The last ring to the first.
  for (std::uint32_t s = 0; s < kSides; ++s) {
    const std::uint32_t a = (kTurns - 1) * kSides + s;
    const std::uint32_t b = (kTurns - 1) * kSides + (s + 1) % kSides;
    sheet.triangles.insert(sheet.triangles.end(), {a, b, (s + 1) % kSides, a, (s + 1) % kSides, s});
  }
  // Rows go round the opening here: turn the triangles where they face inwards.
  const auto at = [&](std::size_t k) -> const AvatarVertex& {
    return sheet.vertices[sheet.triangles[k]];
  };
  const Vector3f face = (at(1).place_m - at(0).place_m).cross(at(2).place_m - at(0).place_m);
  if (face.dot(at(0).normal) < 0.0f)
    for (std::size_t t = 0; t < sheet.triangles.size(); t += 3)
      std::swap(sheet.triangles[t + 1], sheet.triangles[t + 2]);
  return sheet;
}

}  // namespace dance

#include "formats/avatar/make/face/hair_maker.h"

#include <cmath>

namespace dance {

using Eigen::Vector3f;

namespace {

struct StrandPoint {
  Vector3f place_m;  // local to the head
  float radius_m;
};

struct Strand {
  std::string name;
  std::vector<StrandPoint> points;  // one for each node of its chain
  float flat = 1.0f;                // depth beside width
  ModelBuilder::Swing swing;
};

// Between the points a smooth curve (Catmull and Rom's).
StrandPoint point_at(const std::vector<StrandPoint>& points, float at) {
  const auto last = static_cast<int>(points.size()) - 1;
  const int i = std::clamp(static_cast<int>(at), 0, last - 1);
  const float t = at - static_cast<float>(i);
  const auto p = [&](int k) -> const StrandPoint& {
    return points[static_cast<std::size_t>(std::clamp(k, 0, last))];
  };
  const auto blend = [&](const auto& a, const auto& b, const auto& c, const auto& d) {
    return 0.5f * ((2.0f * b) + (c - a) * t + (2.0f * a - 5.0f * b + 4.0f * c - d) * (t * t) +
                   (3.0f * b - a - 3.0f * c + d) * (t * t * t));
  };
  StrandPoint out;
  out.place_m = blend(p(i - 1).place_m, p(i).place_m, p(i + 1).place_m, p(i + 2).place_m);
  out.radius_m = std::max(
      0.001f, blend(p(i - 1).radius_m, p(i).radius_m, p(i + 1).radius_m, p(i + 2).radius_m));
  return out;
}

Sheet strand_sheet(const FaceSurface& face, const Strand& strand, const std::vector<int>& chain) {
  constexpr int kSides = 10;
  constexpr int kRingsOfJoint = 3;
  const int rings = kRingsOfJoint * (static_cast<int>(strand.points.size()) - 1) + 1;
  Sheet sheet;
  for (int ring = rings - 1; ring >= 0; --ring) {  // rows go up
    const float at = static_cast<float>(ring) / kRingsOfJoint;
    const StrandPoint here = point_at(strand.points, at);
    const StrandPoint next = point_at(strand.points, at + 0.1f);
    const StrandPoint before = point_at(strand.points, at - 0.1f);
    const Vector3f down = (next.place_m - before.place_m).normalized();
    const Vector3f side = (Vector3f::UnitX() - down.x() * down).normalized();
    const Vector3f front = side.cross(down).normalized();
    for (int s = 0; s < kSides; ++s) {
      const float turn = kTwoPi * static_cast<float>(s) / kSides;
      // Grooves, as of single locks.
      const float r = here.radius_m * (1.0f + 0.1f * std::cos(5.0f * turn));
      const Vector3f out = std::sin(turn) * side + strand.flat * std::cos(turn) * -front;
      AvatarVertex vertex = vertex_at(face.at(here.place_m + r * out));
      const auto joint = static_cast<std::size_t>(at);
      const std::size_t first = std::min(joint, chain.size() - 1);
      const std::size_t second = std::min(joint + 1, chain.size() - 1);
      // A node turns what hangs below it; the last one is an end and turns nothing.
      const auto turns = [&](std::size_t k) { return chain[std::min(k, chain.size() - 2)]; };
      tie(vertex, turns(first), turns(second), at - static_cast<float>(joint));
      if (ring == 0) tie(vertex, kHeadJoint, chain[0], 0.5f);
      sheet.vertices.push_back(vertex);
    }
  }
  join_rows(sheet, 0, static_cast<std::uint32_t>(rings), kSides, RowEnds::kJoined);
  // Its lower end is closed; the upper one is inside the hair.
  for (std::uint32_t s = 1; s + 1 < kSides; ++s)
    sheet.triangles.insert(sheet.triangles.end(), {0, s + 1, s});
  set_normals(sheet);
  return sheet;
}

std::vector<Strand> strands_of(Hair style) {
  std::vector<Strand> strands;
  if (style == Hair::kPonytail) {
    Strand tail{"ponytail", {}, 0.85f, {0.9f, 0.25f, 0.35f, 0.03f}};
    tail.points = {{{0, 0.152f, -0.108f}, 0.02f},   {{0, 0.135f, -0.155f}, 0.036f},
                   {{0, 0.07f, -0.18f}, 0.044f},    {{0, -0.01f, -0.178f}, 0.038f},
                   {{0, -0.085f, -0.168f}, 0.024f}, {{0.004f, -0.14f, -0.172f}, 0.004f}};
    strands.push_back(std::move(tail));
  }
  if (style == Hair::kPonytail || style == Hair::kBun)
    for (const float s : {1.0f, -1.0f}) {
      Strand lock{s > 0.0f ? "leftLock" : "rightLock", {}, 0.55f, {1.0f, 0.15f, 0.4f, 0.008f}};
      lock.points = {{{0.066f * s, 0.142f, 0.042f}, 0.011f},
                     {{0.081f * s, 0.1f, 0.044f}, 0.0125f},
                     {{0.08f * s, 0.055f, 0.04f}, 0.0095f},
                     {{0.072f * s, 0.018f, 0.046f}, 0.003f}};
      strands.push_back(std::move(lock));
    }
  return strands;
}

class HairLayer {
 public:
  explicit HairLayer(const FaceSurface& face) : face_(face) {
    layer_.material = Material::kHair;
    layer_.cell_m = face.scale() * 0.009f;
    layer_.blend_m = face.scale() * 0.011f;
    layer_.skinning = FigureSkinning::kHead;
  }
  void add(const Vector3f& a_m, float radius_a_m, const Vector3f& b_m, float radius_b_m,
           float width = 1.0f, float depth = 1.0f) {
    FigurePart part;
    part.a_m = face_.at(a_m);
    part.b_m = face_.at(b_m);
    part.radius_a_m = face_.scale() * radius_a_m;
    part.radius_b_m = face_.scale() * radius_b_m;
    part.width = width;
    part.depth = depth;
    layer_.parts.push_back(part);
  }
  FigureLayer take() { return std::move(layer_); }

 private:
  const FaceSurface& face_;
  FigureLayer layer_;
};

}  // namespace

FigureLayer hair_layer(const FaceSurface& face, Hair style) {
  HairLayer hair(face);
  hair.add({0, 0.122f, -0.022f}, 0.088f, {0, 0.132f, -0.016f}, 0.085f, 0.94f, 1.06f);
  switch (style) {
    case Hair::kShort:
      // Close at sides and neck, longer above the brow, swept to one side.
      hair.add({0, 0.1f, -0.034f}, 0.075f, {0, 0.052f, -0.036f}, 0.058f);
      hair.add({-0.04f, 0.178f, 0.058f}, 0.02f, {0.03f, 0.2f, 0.052f}, 0.026f);
      hair.add({0.03f, 0.2f, 0.05f}, 0.027f, {0.056f, 0.176f, 0.036f}, 0.018f);
      hair.add({-0.03f, 0.19f, 0.03f}, 0.03f, {0.025f, 0.205f, 0.0f}, 0.034f);
      for (const float s : {1.0f, -1.0f})
        hair.add({0.07f * s, 0.125f, 0.022f}, 0.012f, {0.074f * s, 0.088f, 0.012f}, 0.007f, 0.6f);
      break;
    case Hair::kBob:
      hair.add({0, 0.11f, -0.028f}, 0.09f, {0, 0.03f, -0.03f}, 0.087f, 1.04f, 0.86f);
      hair.add({-0.02f, 0.188f, 0.05f}, 0.02f, {0.06f, 0.142f, 0.05f}, 0.014f);
      hair.add({-0.02f, 0.188f, 0.05f}, 0.02f, {-0.064f, 0.146f, 0.044f}, 0.013f);
      break;
    case Hair::kBun:
    case Hair::kPonytail: {
      // Combed back from a parting; locks frame the brow.
      hair.add({0, 0.1f, -0.034f}, 0.075f, {0, 0.078f, -0.036f}, 0.062f);
      hair.add({-0.022f, 0.19f, 0.044f}, 0.017f, {0.034f, 0.172f, 0.062f}, 0.014f);
      hair.add({0.034f, 0.172f, 0.062f}, 0.014f, {0.068f, 0.132f, 0.04f}, 0.01f);
      hair.add({-0.022f, 0.19f, 0.044f}, 0.017f, {-0.052f, 0.166f, 0.054f}, 0.012f);
      hair.add({-0.052f, 0.166f, 0.054f}, 0.012f, {-0.07f, 0.134f, 0.036f}, 0.009f);
      if (style == Hair::kBun) {
        hair.add({0, 0.168f, -0.112f}, 0.044f, {0, 0.172f, -0.116f}, 0.046f);
      } else {
        hair.add({0, 0.152f, -0.09f}, 0.034f, {0, 0.154f, -0.116f}, 0.024f);
      }
      break;
    }
  }
  return hair.take();
}

Sheet swinging_hair(const FaceSurface& face, Hair style, ModelBuilder& builder,
                    const std::vector<std::uint32_t>& colliders) {
  Sheet sheet;
  for (const Strand& strand : strands_of(style)) {
    std::vector<int> chain;
    for (std::size_t p = 0; p < strand.points.size(); ++p)
      chain.push_back(builder.add_node(strand.name + std::to_string(p + 1),
                                       chain.empty() ? kHeadJoint : chain.back(),
                                       face.at(strand.points[p].place_m)));
    builder.add_spring(chain, strand.swing, colliders);
    add_to(sheet, strand_sheet(face, strand, chain));
  }
  return sheet;
}

}  // namespace dance

#include "viewer/stage/place/place_builder.h"

#include <algorithm>
#include <cmath>

#include "core/base/smooth_step.h"

namespace dance {

using Eigen::Vector3f;

namespace {

constexpr float kPanelPiece_m = 0.8f;
constexpr int kMostPanelPieces = 28;
constexpr float kApron_m = 5.0f;
// Corners are darker, as less of the room lights them.
constexpr float kCorner_m = 1.1f;
constexpr float kInCorner = 0.55f;
constexpr float kLeastDistance_m = 0.15f;

int pieces_of(float length_m) {
  return std::clamp(static_cast<int>(std::ceil(length_m / kPanelPiece_m)), 1, kMostPanelPieces);
}

}  // namespace

PlaceBuilder::PlaceBuilder(Venue place, const PlaceRoom& room, float height_m) {
  shape_.place = place;
  shape_.room = room;
  shape_.height_m = height_m;
  axes_ = axes_of(PlaceSide::kBack);
}

float PlaceBuilder::width_m(PlaceSide side) const {
  const PlaceRoom& room = shape_.room;
  const bool is_along_z = side == PlaceSide::kLeft || side == PlaceSide::kRight;
  return is_along_z ? room.front_m - room.back_m : room.right_m - room.left_m;
}

PlaceBuilder::Axes PlaceBuilder::axes_of(PlaceSide side) const {
  const PlaceRoom& room = shape_.room;
  const Vector3f x = Vector3f::UnitX(), y = Vector3f::UnitY(), z = Vector3f::UnitZ();
  switch (side) {
    case PlaceSide::kBack:
      return {Vector3f(room.left_m, 0.0f, room.back_m), x, y, z};
    case PlaceSide::kFront:
      return {Vector3f(room.right_m, 0.0f, room.front_m), -x, y, -z};
    case PlaceSide::kLeft:
      return {Vector3f(room.left_m, 0.0f, room.front_m), -z, y, x};
    case PlaceSide::kRight:
      return {Vector3f(room.right_m, 0.0f, room.back_m), z, y, -x};
    case PlaceSide::kAbove:
      return {Vector3f(room.left_m, shape_.height_m, room.back_m), x, z, -y};
    case PlaceSide::kFloor:
    case PlaceSide::kFar:
      break;
  }
  return {Vector3f::Zero(), x, y, z};
}

void PlaceBuilder::add_lamp(PlaceSide side, float u, float v, float w, const Vector3f& colour,
                            float reach_m) {
  const Axes axes = axes_of(side);
  lamps_.push_back({axes.origin + u * axes.u + v * axes.v + w * axes.w, colour, reach_m});
}

void PlaceBuilder::begin(PlaceSide side, float depth_m, PlaceGroup::Kind kind) {
  axes_ = axes_of(side);
  PlaceGroup group{side, kind, depth_m};
  group.first = shape_.vertices.size();
  group.first_halo = shape_.halos.size();
  shape_.groups.push_back(group);
}

Vector3f PlaceBuilder::point(float u, float v, float w) const {
  return axes_.origin + u * axes_.u + v * axes_.v + w * axes_.w;
}

float PlaceBuilder::openness(const Vector3f& p, const Vector3f& n) const {
  const PlaceRoom& room = shape_.room;
  float nearest = kCorner_m;
  const auto note = [&](float along, float distance) {
    if (std::abs(along) < 0.5f) nearest = std::min(nearest, std::max(0.0f, distance));
  };
  note(n.y(), p.y());
  if (shape_.height_m > 0.0f) {
    note(n.y(), shape_.height_m - p.y());
    note(n.x(), std::min(p.x() - room.left_m, room.right_m - p.x()));
    note(n.z(), std::min(p.z() - room.back_m, room.front_m - p.z()));
  }
  return kInCorner + (1.0f - kInCorner) * smooth_step(nearest / kCorner_m);
}

// light = Σ colour · facing / (1 + (d / reach)²), and the mood's light from above and below.
PlaceVertex PlaceBuilder::lit(const Vector3f& p, const Vector3f& n, const Vector3f& albedo) const {
  const StageMood& mood = shape_.mood;
  const float up = 0.5f + 0.5f * n.y();
  const Vector3f steady = openness(p, n) * (mood.bounce + up * (mood.sky - mood.bounce));
  Vector3f of_lamps = Vector3f::Zero();
  for (const PlaceLamp& lamp : lamps_) {
    const Vector3f to_lamp = lamp.place_W_m - p;
    const float distance = std::max(kLeastDistance_m, to_lamp.norm());
    const float share = distance / lamp.reach_m;
    // Other walls reflect the lamp's light, so faces at right angles to it are not black.
    const float facing = std::max(0.0f, 0.25f + 0.75f * n.dot(to_lamp) / distance);
    of_lamps += facing / (1.0f + share * share) * lamp.colour;
  }
  const float whole = steady.sum() + of_lamps.sum();
  return {p, albedo.cwiseProduct(steady + of_lamps), whole > 0.0f ? of_lamps.sum() / whole : 0.0f};
}

void PlaceBuilder::append(const PlaceVertex& a, const PlaceVertex& b, const PlaceVertex& c,
                          const PlaceVertex& d) {
  auto& vertices = shape_.vertices;
  vertices.insert(vertices.end(), {a, b, c, d});
  shape_.groups.back().count += 4;
}

void PlaceBuilder::add_quad(const std::array<Vector3f, 4>& corners,
                            const std::array<Vector3f, 4>& colours, float of_lamps) {
  append({corners[0], colours[0], of_lamps}, {corners[1], colours[1], of_lamps},
         {corners[2], colours[2], of_lamps}, {corners[3], colours[3], of_lamps});
}

void PlaceBuilder::add_lit_quad(const std::array<Vector3f, 4>& corners, const Vector3f& n,
                                const Vector3f& albedo) {
  append(lit(corners[0], n, albedo), lit(corners[1], n, albedo), lit(corners[2], n, albedo),
         lit(corners[3], n, albedo));
}

void PlaceBuilder::add_panel(const PlaceRect& rect, float w, const Vector3f& albedo) {
  const int across = pieces_of(rect.right_m - rect.left_m);
  const int up = pieces_of(rect.top_m - rect.bottom_m);
  const auto at = [&](int i, int j) {
    const float s = static_cast<float>(i) / static_cast<float>(across);
    const float t = static_cast<float>(j) / static_cast<float>(up);
    return point(rect.left_m + s * (rect.right_m - rect.left_m),
                 rect.bottom_m + t * (rect.top_m - rect.bottom_m), w);
  };
  for (int j = 0; j < up; ++j)
    for (int i = 0; i < across; ++i)
      add_lit_quad({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}, axes_.w, albedo);
}

void PlaceBuilder::add_box(const PlaceRect& rect, float back, float front, const Vector3f& albedo) {
  const auto [l, r, b, t] = rect;
  add_panel(rect, front, albedo);
  const auto p = [&](float u, float v, float w) { return point(u, v, w); };
  add_lit_quad({p(l, t, front), p(r, t, front), p(r, t, back), p(l, t, back)}, axes_.v, albedo);
  add_lit_quad({p(l, b, back), p(r, b, back), p(r, b, front), p(l, b, front)}, -axes_.v, albedo);
  add_lit_quad({p(l, b, back), p(l, b, front), p(l, t, front), p(l, t, back)}, -axes_.u, albedo);
  add_lit_quad({p(r, b, front), p(r, b, back), p(r, t, back), p(r, t, front)}, axes_.u, albedo);
}

void PlaceBuilder::add_bright_panel(const PlaceRect& rect, float w, const Vector3f& below,
                                    const Vector3f& above, float of_lamps) {
  const auto [l, r, b, t] = rect;
  add_quad({point(l, b, w), point(r, b, w), point(r, t, w), point(l, t, w)},
           {below, below, above, above}, of_lamps);
}

void PlaceBuilder::add_bright_box(const PlaceRect& rect, float back, float front,
                                  const Vector3f& colour, float of_lamps) {
  const auto [l, r, b, t] = rect;
  const auto p = [&](float u, float v, float w) { return point(u, v, w); };
  const auto add = [&](const std::array<Vector3f, 4>& corners) {
    add_quad(corners, {colour, colour, colour, colour}, of_lamps);
  };
  add({p(l, b, front), p(r, b, front), p(r, t, front), p(l, t, front)});
  add({p(l, t, front), p(r, t, front), p(r, t, back), p(l, t, back)});
  add({p(l, b, back), p(r, b, back), p(r, b, front), p(l, b, front)});
  add({p(l, b, back), p(l, b, front), p(l, t, front), p(l, t, back)});
  add({p(r, b, front), p(r, b, back), p(r, t, back), p(r, t, front)});
}

void PlaceBuilder::add_halo(float u, float v, float w, float radius_m, const Vector3f& colour) {
  shape_.halos.push_back({point(u, v, w), radius_m, colour});
  ++shape_.groups.back().halo_count;
}

void PlaceBuilder::add_bulb(float u, float v, float w, float size_m, const Vector3f& colour,
                            float halo_m) {
  const float half = 0.5f * size_m;
  add_bright_box({u - half, u + half, v - half, v + half}, w - half, w + half, colour, 1.0f);
  add_halo(u, v, w, halo_m, 0.22f * colour);
}

void PlaceBuilder::add_string_of_bulbs(const Vector3f& from, const Vector3f& to, float sag_m,
                                       int bulbs, const Vector3f& colour) {
  constexpr float kWire_m = 0.008f;
  const Vector3f dark = Vector3f::Constant(0.012f);
  const auto at = [&](int i) -> Vector3f {
    const float s = static_cast<float>(i) / static_cast<float>(bulbs + 1);
    return from + s * (to - from) - Vector3f(0.0f, 4.0f * sag_m * s * (1.0f - s), 0.0f);
  };
  for (int i = 0; i <= bulbs; ++i) {
    const Vector3f a = at(i), b = at(i + 1), thick(0.0f, kWire_m, 0.0f);
    const auto p = [&](const Vector3f& q) { return point(q.x(), q.y(), q.z()); };
    add_quad({p(a), p(b), p(b + thick), p(a + thick)}, {dark, dark, dark, dark}, 0.0f);
    if (i > 0) add_bulb(a.x(), a.y() - 0.05f, a.z(), 0.06f, colour, 0.28f);
  }
}

void PlaceBuilder::add_grid(float x0, float x1, float z0, float z1) {
  const int across = pieces_of(x1 - x0), along = pieces_of(z1 - z0);
  const auto at = [&](int i, int j) {
    return Vector3f(x0 + (x1 - x0) * static_cast<float>(i) / static_cast<float>(across), 0.0f,
                    z1 + (z0 - z1) * static_cast<float>(j) / static_cast<float>(along));
  };
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < across; ++i)
      add_lit_quad({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}, Vector3f::UnitY(),
                   Vector3f::Ones());
}

void PlaceBuilder::add_floor() {
  const PlaceRoom& room = shape_.room;
  using Kind = PlaceGroup::Kind;
  begin(PlaceSide::kFloor, 0.0f, Kind::kFloor);
  add_grid(room.left_m, room.right_m, room.back_m, room.front_m);
  const float left = room.left_m - kApron_m, right = room.right_m + kApron_m;
  begin(PlaceSide::kBack, 0.0f, Kind::kApron);
  add_grid(left, right, room.back_m - kApron_m, room.back_m);
  begin(PlaceSide::kFront, 0.0f, Kind::kApron);
  add_grid(left, right, room.front_m, room.front_m + kApron_m);
  begin(PlaceSide::kLeft, 0.0f, Kind::kApron);
  add_grid(left, room.left_m, room.back_m, room.front_m);
  begin(PlaceSide::kRight, 0.0f, Kind::kApron);
  add_grid(room.right_m, right, room.back_m, room.front_m);
}

}  // namespace dance

#include "formats/avatar/make/sheet.h"

#include <array>
#include <cmath>
#include <tuple>

namespace dance {

using Eigen::Vector3f;

AvatarVertex vertex_at(const Vector3f& place_m, const Eigen::Vector2f& uv) {
  return {place_m, Vector3f::UnitY(), uv, {}, {255, 0, 0, 0}};
}

void tie(AvatarVertex& vertex, int joint) { tie(vertex, joint, joint, 0.0f); }

void tie(AvatarVertex& vertex, int first, int second, float share) {
  const auto part = static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(share, 0.0f, 1.0f)));
  vertex.joints = {static_cast<std::uint16_t>(part < 255 ? first : 0),
                   static_cast<std::uint16_t>(part > 0 ? second : 0), 0, 0};
  vertex.weights = {static_cast<std::uint8_t>(255 - part), part, 0, 0};
}

Sheet points_of(const std::vector<Vector3f>& places_m, int joint) {
  Sheet sheet;
  for (const Vector3f& place_m : places_m) {
    AvatarVertex vertex = vertex_at(place_m);
    tie(vertex, joint);
    sheet.vertices.push_back(vertex);
  }
  return sheet;
}

void join_rows(Sheet& sheet, std::uint32_t first, std::uint32_t rows, std::uint32_t columns,
               RowEnds ends) {
  const std::uint32_t quads = ends == RowEnds::kJoined ? columns : columns - 1;
  for (std::uint32_t r = 0; r + 1 < rows; ++r)
    for (std::uint32_t c = 0; c < quads; ++c) {
      const std::uint32_t a = first + r * columns + c;
      const std::uint32_t b = first + r * columns + (c + 1) % columns;
      sheet.triangles.insert(sheet.triangles.end(),
                             {a, b, b + columns, a, b + columns, a + columns});
    }
}

void set_normals(Sheet& sheet) {
  const auto key_of = [](const Vector3f& p) {
    const auto rounded = [](float x) { return std::lround(x * 1e5f); };
    return std::tuple(rounded(p.x()), rounded(p.y()), rounded(p.z()));
  };
  std::map<std::tuple<long, long, long>, Vector3f> sums;
  for (std::size_t t = 0; t < sheet.triangles.size(); t += 3) {
    const auto at = [&](std::size_t k) -> const Vector3f& {
      return sheet.vertices[sheet.triangles[t + k]].place_m;
    };
    const Vector3f face = (at(1) - at(0)).cross(at(2) - at(0));
    for (std::size_t k = 0; k < 3; ++k)
      sums.try_emplace(key_of(at(k)), Vector3f::Zero()).first->second += face;
  }
  for (AvatarVertex& vertex : sheet.vertices) {
    const auto found = sums.find(key_of(vertex.place_m));
    const bool is_known = found != sums.end() && found->second.norm() > 1e-12f;
    vertex.normal = is_known ? Vector3f(found->second.normalized()) : Vector3f(Vector3f::UnitY());
  }
}

void add_to(Sheet& sheet, const Sheet& more) {
  const auto first = static_cast<std::uint32_t>(sheet.vertices.size());
  // A shape that only one of the two has leaves the other as it is.
  const auto at_rest = [](const Sheet& of) {
    std::vector<Vector3f> places;
    for (const AvatarVertex& vertex : of.vertices) places.push_back(vertex.place_m);
    return places;
  };
  for (const auto& [name, places] : more.shapes) sheet.shapes.try_emplace(name, at_rest(sheet));
  for (auto& [name, places] : sheet.shapes) {
    const auto found = more.shapes.find(name);
    const std::vector<Vector3f> added = found != more.shapes.end() ? found->second : at_rest(more);
    places.insert(places.end(), added.begin(), added.end());
  }
  sheet.vertices.insert(sheet.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const std::uint32_t vertex : more.triangles) sheet.triangles.push_back(first + vertex);
}

}  // namespace dance

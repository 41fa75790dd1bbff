#include "formats/avatar/make/cloth_map.h"

#include <array>
#include <cmath>
#include <tuple>

namespace dance {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

constexpr float kPicture_m = 0.22f;  // along the body
constexpr float kHalfBreadth_m = 0.2f;
constexpr float kAcross = 2.4f;  // pictures, from one side of the trunk to the other
constexpr float kAroundSleeve = 2.0f;

}  // namespace

void map_shirt(Sheet& sheet, const TposePlaces& places) {
  const float size_m = places.scale * kPicture_m;
  const float shoulder_m = places.at(Bone::kLeftUpperArm).x();
  const Vector3f arm = places.at(Bone::kLeftUpperArm);
  const auto uv_of = [&](const Vector3f& p, bool is_sleeve) -> Vector2f {
    if (is_sleeve)
      return {kAroundSleeve * (std::atan2(p.z() - arm.z(), p.y() - arm.y()) / kTwoPi + 0.5f),
              std::abs(p.x()) / size_m};
    // As on a cylinder as broad as the chest, front and back alike, so that stripes run straight up
    // to a narrow neck.
    const float x = std::clamp(p.x() / (places.scale * kHalfBreadth_m), -1.0f, 1.0f);
    return {kAcross * (0.5f + std::asin(x) / (0.5f * kTwoPi)), -p.y() / size_m};
  };
  using Key = std::tuple<std::uint32_t, bool, bool>;  // vertex, on a sleeve, beyond the seam
  std::map<Key, std::uint32_t> made;
  Sheet mapped;
  for (std::size_t t = 0; t < sheet.triangles.size(); t += 3) {
    const auto place = [&](std::size_t k) -> const Vector3f& {
      return sheet.vertices[sheet.triangles[t + k]].place_m;
    };
    const float aside_m = std::abs(place(0).x() + place(1).x() + place(2).x()) / 3.0f;
    const bool is_sleeve = aside_m > shoulder_m;
    std::array<Vector2f, 3> uv;
    float most = -1e9f;
    for (std::size_t k = 0; k < 3; ++k) {
      uv[k] = uv_of(place(k), is_sleeve);
      most = std::max(most, uv[k].x());
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const bool is_beyond = is_sleeve && most - uv[k].x() > 0.5f * kAroundSleeve;
      const std::uint32_t from = sheet.triangles[t + k];
      const auto [at, is_new] = made.try_emplace(
          Key(from, is_sleeve, is_beyond), static_cast<std::uint32_t>(mapped.vertices.size()));
      if (is_new) {
        mapped.vertices.push_back(sheet.vertices[from]);
        mapped.vertices.back().uv = uv[k] + Vector2f(is_beyond ? kAroundSleeve : 0.0f, 0.0f);
      }
      mapped.triangles.push_back(at->second);
    }
  }
  sheet = std::move(mapped);
}

}  // namespace dance

#include "producers/camera/region/picture_region.h"

#include "producers/camera/region/half_turn.h"

namespace dance {

using Eigen::Vector2f;

namespace {

// The network sees a little more than the circle about the hips that the body fits in.
constexpr float kMargin = 1.25f;
constexpr float kUp = 0.1f;
constexpr float kLeastSide_px = 1.0f, kMostGrowth = 100.0f;

}  // namespace

float within_half_turns(float angle_rad) {
  return angle_rad -
         2.0f * kHalfTurn_rad * std::floor((angle_rad + kHalfTurn_rad) / (2.0f * kHalfTurn_rad));
}

float turn_from_up(const Vector2f& direction) {
  return within_half_turns(0.5f * kHalfTurn_rad - std::atan2(-direction.y(), direction.x()));
}
float turn_from_right(const Vector2f& direction) {
  return within_half_turns(-std::atan2(-direction.y(), direction.x()));
}

Vector2f turned(const Vector2f& v, float turn_rad) {
  const float c = std::cos(turn_rad), s = std::sin(turn_rad);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

BodyRegion region_of(const Vector2f& middle_px, const Vector2f& edge_px) {
  const Vector2f up = edge_px - middle_px;
  return {middle_px.x(), middle_px.y(), 2.0f * kMargin * up.norm(), turn_from_up(up)};
}

BodyRegion moved_region(const Vector2f& middle_px, float side_px, float turn_rad, float scale) {
  const Vector2f middle = middle_px + turned({0.0f, -kUp * side_px}, turn_rad);
  return {middle.x(), middle.y(), scale * side_px, turn_rad};
}

bool is_usable(const BodyRegion& found, const BodyRegion& searched) {
  return found.side_px >= kLeastSide_px && found.side_px <= kMostGrowth * searched.side_px;
}

void read_points(const BodyRegion& region, std::span<const float> numbers, float size_px,
                 float depth_px, std::span<Eigen::Vector3f> image_px) {
  const RegionFrame frame(region);
  for (std::size_t i = 0; i < image_px.size(); ++i) {
    const float* n = numbers.data() + 3 * i;
    const Vector2f p = frame.in_picture(Vector2f(n[0], n[1]) / size_px);
    image_px[i] = {p.x(), p.y(), region.side_px * n[2] / depth_px};
  }
}

}  // namespace dance

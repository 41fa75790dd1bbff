// Turned squares of a picture: from a place in one to a place in the picture, and how networks name
// them by two points.
//
// Units/frames: places in pixels, (0, 0) the left upper corner of the left upper pixel; shares of
//               a region's side, (0, 0) its left upper corner and (1, 1) its right lower one. y
//               points down, angles are clockwise.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <cmath>
#include <span>

#include "producers/camera/body_landmarks.h"

namespace dance {

inline Eigen::Vector2f centre_of(const BodyRegion& region) {
  return {region.centre_x_px, region.centre_y_px};
}

float within_half_turns(float angle_rad);
Eigen::Vector2f turned(const Eigen::Vector2f& v, float turn_rad);
// How far the direction is turned from one that points up, or to the right.
float turn_from_up(const Eigen::Vector2f& direction);
float turn_from_right(const Eigen::Vector2f& direction);

// The region whose middle is `middle`, and whose upper edge `edge` says together with the size: how
// the networks name a body.
BodyRegion region_of(const Eigen::Vector2f& middle_px, const Eigen::Vector2f& edge_px);
// Whether a region that a network found in another is one to look at: not smaller than a pixel, nor
// a hundred times as large as the other.
bool is_usable(const BodyRegion& found, const BodyRegion& searched);

// A square whose upper edge is turned by so much, moved up by a tenth of its side and then scaled:
// how the networks of hands and faces have it.
BodyRegion moved_region(const Eigen::Vector2f& middle_px, float side_px, float turn_rad,
                        float scale);

// A region's axes, for many places.
class RegionFrame {
 public:
  explicit RegionFrame(const BodyRegion& region)
      : centre_px_(centre_of(region)),
        side_px_(region.side_px),
        cos_(std::cos(region.turn_rad)),
        sin_(std::sin(region.turn_rad)) {}
  // From the region's axes to the picture's.
  Eigen::Vector2f turned(const Eigen::Vector2f& v) const {
    return {cos_ * v.x() - sin_ * v.y(), sin_ * v.x() + cos_ * v.y()};
  }
  Eigen::Vector2f in_picture(const Eigen::Vector2f& share) const {
    return centre_px_ + side_px_ * turned(share - Eigen::Vector2f(0.5f, 0.5f));
  }
  // How far a place of the picture is from the region's middle, in the region's axes.
  Eigen::Vector2f offset(const Eigen::Vector2f& place_px) const {
    const Eigen::Vector2f v = place_px - centre_px_;
    return {cos_ * v.x() + sin_ * v.y(), cos_ * v.y() - sin_ * v.x()};
  }

 private:
  Eigen::Vector2f centre_px_;
  float side_px_, cos_, sin_;
};

// A network's points, three numbers each: pixels of its picture of the region, size_px across, and
// a depth in which depth_px is the region's side. In pixels of the whole picture.
void read_points(const BodyRegion& region, std::span<const float> numbers, float size_px,
                 float depth_px, std::span<Eigen::Vector3f> image_px);

}  // namespace dance

#include "viewer/stage/place/place_shape.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "viewer/stage/place/places.h"

namespace dance {

using Eigen::Vector3f;

namespace {

// A group fades in and out over this distance, so that nothing pops up while the camera moves.
constexpr float kFades_m = 0.6f;

// A wall moves in steps of this size: a place is made again only when its room changes, and that
// costs milliseconds.
constexpr float kWallStep_m = 2.0f;

// The distance of a wall from the origin, in whole steps beyond its usual place.
float wall_m(float usual_m, float needed_m) {
  const float steps = std::ceil(std::max(0.0f, needed_m - usual_m) / kWallStep_m);
  return std::min(usual_m + kWallStep_m * steps, kLargestRoom_m);
}

// The eye's distance from the wall, positive inside the room.
float distance_inside_m(const PlaceShape& shape, PlaceSide side, const Vector3f& eye_W_m) {
  const PlaceRoom& room = shape.room;
  switch (side) {
    case PlaceSide::kBack:
      return eye_W_m.z() - room.back_m;
    case PlaceSide::kFront:
      return room.front_m - eye_W_m.z();
    case PlaceSide::kLeft:
      return eye_W_m.x() - room.left_m;
    case PlaceSide::kRight:
      return room.right_m - eye_W_m.x();
    case PlaceSide::kAbove:
      return shape.height_m - eye_W_m.y();
    case PlaceSide::kFloor:
    case PlaceSide::kFar:
      break;
  }
  return kLargestRoom_m;
}

}  // namespace

PlaceRoom room_around(const Eigen::AlignedBox3f& guests_W_m) {
  PlaceRoom room;
  if (guests_W_m.isEmpty()) return room;
  const Vector3f low = guests_W_m.min().array() - kFreeFromWalls_m;
  const Vector3f high = guests_W_m.max().array() + kFreeFromWalls_m;
  room.left_m = -wall_m(-room.left_m, -low.x());
  room.right_m = wall_m(room.right_m, high.x());
  room.back_m = -wall_m(-room.back_m, -low.z());
  room.front_m = wall_m(room.front_m, high.z());
  return room;
}

PlaceShape make_place(Venue place, const PlaceRoom& room) {
  DANCE_ASSERT(place != Venue::kPlain, static_cast<int>(place));
  if (place == Venue::kStudio) return studio_place::make(room);
  return place == Venue::kBar ? bar_place::make(room) : terrace_place::make(room);
}

float opacity_for(const PlaceShape& shape, const PlaceGroup& group, const Vector3f& eye_W_m) {
  const float inside_m = distance_inside_m(shape, group.side, eye_W_m) - group.depth_m;
  return std::clamp(inside_m / kFades_m, 0.0f, 1.0f);
}

}  // namespace dance

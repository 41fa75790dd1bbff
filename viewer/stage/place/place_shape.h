// PlaceShape: the geometry, colours and lamps of a place, made by code for a room of a given size.
// The lamps' light is computed once for each vertex, so drawing needs no lamps. Walls face inwards.
// Each wall is a group with the things in front of it, and is not drawn while the camera is behind
// it.
//
// Units/frames: metres in W; the floor is y = 0. Colours are linear RGB.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "viewer/scene/place.h"
#include "viewer/stage/stage_light.h"

namespace dance {

// The walls' places on the floor.
struct PlaceRoom {
  float left_m = -6.0f, right_m = 6.0f;  // along X
  float back_m = -5.0f, front_m = 5.0f;  // along Z
  bool operator==(const PlaceRoom&) const = default;
};

// The usual room, extended in steps of 2 m where guests stand near a wall or beyond it; at most to
// kLargestRoom_m.
PlaceRoom room_around(const Eigen::AlignedBox3f& guests_W_m);
// The limit of a wall's distance from the origin. A guest who jumps to and fro makes each display
// build the room again for each picture, so the largest room must be cheap too.
constexpr float kLargestRoom_m = 24.0f;
// Guests keep this distance to the walls. The things in front of a wall are nearer to it.
constexpr float kFreeFromWalls_m = 1.7f;

enum class PlaceSide : std::uint8_t { kBack, kFront, kLeft, kRight, kAbove, kFloor, kFar };

struct PlaceVertex {
  Eigen::Vector3f place_W_m;
  Eigen::Vector3f colour;
  float of_lamps;  // share of the colour that varies with the lamps' light
};

// A soft glow round a lamp; it faces the eye.
struct PlaceHalo {
  Eigen::Vector3f place_W_m;
  float radius_m;
  Eigen::Vector3f colour;
};

struct PlaceGroup {
  enum class Kind : std::uint8_t { kSolid, kFloor, kApron, kGlass };
  PlaceSide side;
  Kind kind = Kind::kSolid;
  float depth_m = 0.0f;              // how far into the room its things reach
  std::size_t first = 0, count = 0;  // vertices
  std::size_t first_halo = 0, halo_count = 0;
};

// A mirror in the back wall, in the plane z = z_m.
struct PlaceMirror {
  float left_m, right_m, bottom_m, top_m, z_m;
};

enum class FloorPattern : std::uint8_t { kPlanks, kTiles };
struct PlaceFloor {
  FloorPattern pattern = FloorPattern::kPlanks;
  Eigen::Vector3f light, dark;  // range of the material's colour, plank by plank
  Eigen::Vector3f sheen;        // reflected colour where no mirror image is drawn
  float polish = 1.0f;
};

struct PlaceSky {
  Eigen::Vector3f low, middle, high;
  Eigen::Vector3f ground;  // below the horizon
};

struct PlaceShape {
  Venue place = Venue::kPlain;
  PlaceRoom room;
  float height_m = 0.0f;              // 0: open above
  std::vector<PlaceVertex> vertices;  // four to a quad, counter-clockwise from inside
  std::vector<PlaceHalo> halos;
  std::vector<PlaceGroup> groups;
  std::optional<PlaceMirror> mirror;
  StageMood mood;
  PlaceFloor floor;
  PlaceSky sky;
};

// `place` must not be kPlain.
PlaceShape make_place(Venue place, const PlaceRoom& room);

// The opacity of a group for that eye: 1 inside the room; 0 behind its wall and among the things
// in front of it.
float opacity_for(const PlaceShape& shape, const PlaceGroup& group, const Eigen::Vector3f& eye_W_m);

}  // namespace dance

// Geometry of places: names, bounds, and free sight of each dancer.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "viewer/scene/camera.h"
#include "viewer/stage/place/place_painter.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr std::array kRooms{Venue::kStudio, Venue::kBar, Venue::kTerrace};

TEST(PlaceName, FindsEachPlaceByItsNameAndNoOther) {
  for (const PlaceName& it : kPlaceNames) {
    EXPECT_EQ(parse_place(it.option), it.place) << it.option;
    EXPECT_EQ(name_of(it.place), it.option);
    EXPECT_NE(kPlaceList.find(it.option), std::string_view::npos) << "the list of an error has it";
  }
  for (const char* wrong : {"", "Studio", "disc", "studio "}) EXPECT_FALSE(parse_place(wrong));
}

TEST(PlaceName, GoesThroughAllPlacesBothWays) {
  Venue place = Venue::kStudio;
  for (std::size_t i = 0; i < kPlaceNames.size(); ++i) place = next_place(place, 1);
  EXPECT_EQ(place, Venue::kStudio);
  EXPECT_EQ(next_place(next_place(place, -1), 1), place);
}

Eigen::AlignedBox3f guests_within(float reach_m) {
  return {Vector3f(-reach_m, 0.9f, -reach_m), Vector3f(reach_m, 0.9f, reach_m)};
}

// Signed distance of a point from a wall, positive inside.
float inside_m(const PlaceShape& shape, PlaceSide side, const Vector3f& p) {
  const PlaceRoom& room = shape.room;
  if (side == PlaceSide::kBack) return p.z() - room.back_m;
  if (side == PlaceSide::kFront) return room.front_m - p.z();
  if (side == PlaceSide::kLeft) return p.x() - room.left_m;
  if (side == PlaceSide::kRight) return room.right_m - p.x();
  return shape.height_m - p.y();
}

TEST(PlaceRoom, KeepsGuestsAwayFromWallsAndIsBounded) {
  EXPECT_EQ(room_around({}), PlaceRoom());
  EXPECT_EQ(room_around(guests_within(2.0f)), PlaceRoom()) << "as usual for a couple";
  const PlaceRoom wide = room_around(guests_within(9.0f));
  EXPECT_FLOAT_EQ(wide.right_m, 12.0f) << "the next whole step beyond 10.7 m";
  EXPECT_FLOAT_EQ(wide.back_m, -11.0f);
  EXPECT_EQ(room_around(guests_within(9.2f)), wide) << "a few steps of a dancer change nothing";
  const PlaceRoom endless = room_around(guests_within(1e6f));
  EXPECT_FLOAT_EQ(endless.left_m, -kLargestRoom_m);
  EXPECT_FLOAT_EQ(endless.front_m, kLargestRoom_m);
}

TEST(PlaceShape, IsBoundedInRoomsOfAnySize) {
  for (const Venue place : kRooms)
    for (const float reach_m : {0.0f, 9.0f, 1e6f}) {
      const PlaceShape shape = make_place(place, room_around(guests_within(reach_m)));
      const std::size_t most = reach_m == 0.0f ? 9'000 : 90'000;
      EXPECT_LE(shape.vertices.size() / 2, most) << name_of(place) << " of " << reach_m;
      for (const PlaceVertex& vertex : shape.vertices) {
        ASSERT_TRUE(vertex.place_W_m.allFinite());
        ASSERT_LE(vertex.place_W_m.norm(), 380.0f) << "nearer than the end of the picture";
        ASSERT_GE(vertex.colour.minCoeff(), 0.0f);
        ASSERT_LE(vertex.colour.maxCoeff(), 6.0f);
        ASSERT_GE(vertex.of_lamps, 0.0f);
        ASSERT_LE(vertex.of_lamps, 1.0f);
      }
    }
}

TEST(PlaceShape, KeepsTheThingsOfAWallOffTheFreeFloor) {
  for (const Venue place : kRooms) {
    const PlaceShape shape = make_place(place, PlaceRoom());
    for (const PlaceGroup& group : shape.groups) {
      ASSERT_LE(group.first + group.count, shape.vertices.size());
      if (group.kind != PlaceGroup::Kind::kSolid || group.side == PlaceSide::kFar) continue;
      EXPECT_LE(group.depth_m, kFreeFromWalls_m);
      for (std::size_t i = group.first; i < group.first + group.count; ++i) {
        const float depth = inside_m(shape, group.side, shape.vertices[i].place_W_m);
        ASSERT_GE(depth, -0.01f) << name_of(place) << " vertex " << i;
        ASSERT_LE(depth, group.depth_m + 0.01f) << name_of(place) << " vertex " << i;
      }
      for (std::size_t i = group.first_halo; i < group.first_halo + group.halo_count; ++i)
        ASSERT_LE(inside_m(shape, group.side, shape.halos[i].place_W_m), group.depth_m);
    }
  }
}

// Möller and Trumbore: true if the segment from a to b meets the front of a triangle.
bool meets(const Vector3f& a, const Vector3f& b, const PlaceVertex* corners, int second) {
  const Vector3f way = b - a;
  const Vector3f e1 = corners[second].place_W_m - corners[0].place_W_m;
  const Vector3f e2 = corners[second + 1].place_W_m - corners[0].place_W_m;
  const Vector3f p = way.cross(e2);
  const float facing = e1.dot(p);
  if (facing < 1e-9f) return false;
  const Vector3f s = a - corners[0].place_W_m;
  const float u = s.dot(p) / facing;
  const Vector3f q = s.cross(e1);
  const float v = way.dot(q) / facing, t = e2.dot(q) / facing;
  return u >= 0.0f && v >= 0.0f && u + v <= 1.0f && t > 0.0f && t < 0.999f;
}

bool is_hidden(const PlaceShape& shape, const Vector3f& eye, const Vector3f& p) {
  for (const PlaceGroup& group : shape.groups) {
    if (group.kind != PlaceGroup::Kind::kSolid || opacity_for(shape, group, eye) <= 0.0f) continue;
    for (std::size_t i = group.first; i < group.first + group.count; i += 4)
      for (const int second : {1, 2})
        if (meets(eye, p, &shape.vertices[i], second)) return true;
  }
  return false;
}

TEST(PlaceShape, NeverStandsBetweenACameraAndADancer) {
  constexpr float kFloorsEdge_m = 2.6f;  // of guests in the usual room
  for (const Venue place : kRooms) {
    const PlaceShape shape = make_place(place, room_around(guests_within(kFloorsEdge_m)));
    for (int yaw = 0; yaw < 10; ++yaw)
      for (const float pitch : {-0.05f, 0.13f, 0.5f, 1.5f})
        for (const float distance_m : {1.0f, 4.5f, 6.5f, 22.0f}) {
          OrbitCamera camera;
          camera.yaw_rad = 0.63f * static_cast<float>(yaw);
          camera.pitch_rad = pitch;
          camera.distance_m = distance_m;
          const Vector3f eye = camera.eye_W_m();
          if (eye.y() <= 0.05f) continue;
          for (const Vector3f& at :
               {Vector3f(0, 0.05f, 0), Vector3f(kFloorsEdge_m, 1.0f, 1.0f),
                Vector3f(-kFloorsEdge_m, 1.9f, -kFloorsEdge_m), Vector3f(0.5f, 2.1f, 2.2f)})
            EXPECT_FALSE(is_hidden(shape, eye, at))
                << name_of(place) << ": from " << eye.transpose() << " to " << at.transpose();
        }
  }
}

TEST(LampBreath, IsDeepestOnTheOneAndStillWithoutBars) {
  const auto breath = [](double beats, int beats_per_bar) {
    return lamp_breath(SceneMusic{beats, 2.0, beats_per_bar});
  };
  EXPECT_GT(breath(8.0, 4), breath(8.5, 4));
  EXPECT_GT(breath(8.5, 4), breath(10.0, 4));
  EXPECT_FLOAT_EQ(breath(8.0, 4), breath(12.0, 4));
  EXPECT_FLOAT_EQ(breath(6.0, 3), breath(-3.0, 3)) << "before the music's first beat too";
  EXPECT_LT(std::abs(breath(8.0, 4)), 0.15f) << "gently";
  EXPECT_EQ(breath(8.0, 0), 0.0f) << "bars are not known";
  EXPECT_EQ(lamp_breath(std::nullopt), 0.0f);
}

}  // namespace
}  // namespace dance

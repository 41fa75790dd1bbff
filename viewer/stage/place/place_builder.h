// PlaceBuilder: puts a PlaceShape together from panels and boxes, in the axes of the wall that they
// belong to, and lights each vertex by the lamps.
//
// Units/frames: walls, seen from inside the room: u to the right, v up, w into the room; u and v
//               begin at the lower left corner. Ceiling: u along X, v along Z, w down. Far things:
//               W.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "viewer/stage/place/place_shape.h"

namespace dance {

struct PlaceLamp {
  Eigen::Vector3f place_W_m;
  Eigen::Vector3f colour;
  float reach_m;  // where half of its light is left
};

// A part of a wall.
struct PlaceRect {
  float left_m, right_m, bottom_m, top_m;
};

class PlaceBuilder {
 public:
  PlaceBuilder(Venue place, const PlaceRoom& room, float height_m);

  PlaceShape& shape() { return shape_; }
  PlaceShape take() { return std::move(shape_); }
  float width_m(PlaceSide side) const;
  float height_m() const { return shape_.height_m; }

  // Lamps must be added before the things that they light.
  void add_lamp(PlaceSide side, float u, float v, float w, const Eigen::Vector3f& colour,
                float reach_m);

  // Begins a group: all that is added next belongs to that side and reaches at most `depth_m` into
  // the room.
  void begin(PlaceSide side, float depth_m = 0.0f,
             PlaceGroup::Kind kind = PlaceGroup::Kind::kSolid);
  // A flat panel parallel to the wall, in pieces small enough for the lamps' light.
  void add_panel(const PlaceRect& rect, float w, const Eigen::Vector3f& albedo);
  // A box without a back; its front is at w_front.
  void add_box(const PlaceRect& rect, float w_back, float w_front, const Eigen::Vector3f& albedo);
  // Panels and boxes that shine by themselves.
  void add_bright_panel(const PlaceRect& rect, float w, const Eigen::Vector3f& below,
                        const Eigen::Vector3f& above, float of_lamps);
  void add_bright_box(const PlaceRect& rect, float w_back, float w_front,
                      const Eigen::Vector3f& colour, float of_lamps);
  void add_halo(float u, float v, float w, float radius_m, const Eigen::Vector3f& colour);
  // A shining cube with a halo.
  void add_bulb(float u, float v, float w, float size_m, const Eigen::Vector3f& colour,
                float halo_m);
  // A sagging string between two points, with bulbs.
  void add_string_of_bulbs(const Eigen::Vector3f& from, const Eigen::Vector3f& to, float sag_m,
                           int bulbs, const Eigen::Vector3f& colour);
  // Four corners, counter-clockwise as seen from the front, each with a colour.
  void add_quad(const std::array<Eigen::Vector3f, 4>& corners_W_m,
                const std::array<Eigen::Vector3f, 4>& colours, float of_lamps);

  // The floor, and beyond each wall a strip of it for eyes behind that wall.
  void add_floor();

  Eigen::Vector3f point(float u, float v, float w) const;

 private:
  struct Axes {
    Eigen::Vector3f origin, u, v, w;
  };
  Axes axes_of(PlaceSide side) const;
  PlaceVertex lit(const Eigen::Vector3f& p, const Eigen::Vector3f& n,
                  const Eigen::Vector3f& albedo) const;
  float openness(const Eigen::Vector3f& p, const Eigen::Vector3f& n) const;
  void add_lit_quad(const std::array<Eigen::Vector3f, 4>& corners, const Eigen::Vector3f& n,
                    const Eigen::Vector3f& albedo);
  void add_grid(float x0, float x1, float z0, float z1);
  void append(const PlaceVertex& a, const PlaceVertex& b, const PlaceVertex& c,
              const PlaceVertex& d);

  PlaceShape shape_;
  std::vector<PlaceLamp> lamps_;
  Axes axes_;
};

}  // namespace dance

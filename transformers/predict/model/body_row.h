// BodyRow: one moment of a body as 72 numbers that may be added, scaled and learnt from: what
// prediction computes in. BodySpace turns poses into rows and back.
//
// Units/frames: 24 groups of three: the 22 bones as rotation vectors (rad) from where the bone
//               usually is, the hips without their heading; the hips' place in W (m); the heading
//               about +Y (rad, counted on over full turns). The numbers of one kind lie together
//               (group fastest), so that short loops over groups become vector code. Differences of
//               rows have their place turned into the dancer's heading.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; rotations are unit whatever the row says, as long as it is finite.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "core/pose/pose.h"

namespace dance {

constexpr std::size_t kRowGroups = 24;
constexpr std::size_t kRowSize = 3 * kRowGroups;
constexpr std::size_t kPlaceGroup = 22;
constexpr std::size_t kHeadingGroup = 23;  // its first number; the other two are 0

struct alignas(64) BodyRow {
  std::array<float, kRowSize> v{};

  static constexpr std::size_t at(std::size_t group, std::size_t axis) {
    return axis * kRowGroups + group;
  }
  float& operator()(std::size_t group, std::size_t axis) { return v[at(group, axis)]; }
  float operator()(std::size_t group, std::size_t axis) const { return v[at(group, axis)]; }
  float heading() const { return v[at(kHeadingGroup, 0)]; }
};

// Turns a row's place from W into the frame of a dancer who looks along `heading`, or back.
inline void turn_place(BodyRow& row, float sine, float cosine) {
  float& x = row.v[BodyRow::at(kPlaceGroup, 0)];
  float& z = row.v[BodyRow::at(kPlaceGroup, 2)];
  const float turned = cosine * x + sine * z;
  z = cosine * z - sine * x;
  x = turned;
}
inline void place_into_heading(BodyRow& row, float heading) {
  turn_place(row, -std::sin(heading), std::cos(heading));
}
inline void place_from_heading(BodyRow& row, float heading) {
  turn_place(row, std::sin(heading), std::cos(heading));
}

class BodySpace {
 public:
  explicit BodySpace(const BoneRotations& centres);
  const BoneRotations& centres() const { return centres_; }

  // `before`: the row just before, so that angles are counted on; bones that the pose has not stay
  // as they were there.
  BodyRow row_of(const Pose& pose, const BodyRow* before) const;
  // Writes rotations and place; leaves the rest of the pose.
  void pose_of(const BodyRow& row, Pose& pose) const;

 private:
  BoneRotations centres_;
};

}  // namespace dance

// BodyShape: the size of one dancer: bones, and where on them the points sit that the network sees.
//
// Units/frames: metres; a point's place is in the axes of its bone in T-pose, from the bone's
//               origin.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      none.
// Source:       places of the head's points: Tilley, The Measure of Man and Woman, 2002, shares of
//               the standing height; of the foot's: measured; the rest follows from
//               core/pose/skeleton.h.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/pose/skeleton.h"
#include "producers/camera/body_landmarks.h"

namespace dance {

// The landmarks first, then where feet touch the floor.
enum class Sole : std::uint8_t { kLeftHeel, kLeftBall, kRightHeel, kRightBall };
constexpr std::size_t kSoleCount = 4;
constexpr std::size_t kBodyPointCount = kLandmarkCount + kSoleCount;
constexpr std::size_t point_of(Landmark landmark) { return index_of(landmark); }
constexpr std::size_t point_of(Sole sole) {
  return kLandmarkCount + static_cast<std::size_t>(sole);
}

struct BodyShape {
  Skeleton skeleton;
  std::array<Eigen::Vector3d, kBodyPointCount> point_m;
};

// Which bone carries a point.
Bone bone_of(std::size_t body_point);

// The lengths that are fitted; the rest of the body follows the standing height.
enum class Length : std::uint8_t {
  kShoulders,  // from one shoulder joint to the other
  kHips,
  kTorso,  // between the middles of these two
  kUpperArm,
  kLowerArm,
  kThigh,
  kShank,
  kFoot,  // from what the network calls heel to what it calls foot index
  kEars,
};
constexpr std::size_t kLengthCount = 9;
using BodyLengths = std::array<double, kLengthCount>;  // metres

// All of them so many times as long.
inline BodyLengths scaled(BodyLengths lengths, double by) {
  for (double& length : lengths) length *= by;
  return lengths;
}
// Those of an adult of this height with average proportions.
BodyLengths average_lengths(double height_m);
// A body of these lengths; all others are average for its height.
BodyShape shape_of(const BodyLengths& lengths);
// The same of a person who stands this tall: neck and head are what the rest leaves.
BodyShape shape_of(const BodyLengths& lengths, double stature_m);
// The standing height of a body with these lengths.
double height_of(const BodyLengths& lengths);

}  // namespace dance

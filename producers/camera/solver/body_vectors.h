// BodyVectors: vectors between points of a body whose directions in space the network measures:
// along bones, across the hips and the shoulders, from hand to knuckles. Directions are its best
// measurement; lengths vary by six percent from picture to picture.
//
// Units/frames: each is the mean of two landmarks less the mean of two others.
// Ownership:    constants only.
// Threads:      none.
// Failure:      none.
#pragma once

#include <array>

#include "producers/camera/body_landmarks.h"

namespace dance {

struct BodyVector {
  Landmark from_a, from_b, to_a, to_b;
  double sd;  // of the direction, as a share of the length
};

constexpr BodyVector between(Landmark from, Landmark to, double sd) {
  return {from, from, to, to, sd};
}

constexpr double kBoneSd = 0.11, kAcrossSd = 0.16, kHandSd = 0.35, kFootSd = 0.3;

constexpr std::array<BodyVector, 26> kBodyVectors{{
    between(Landmark::kRightHip, Landmark::kLeftHip, kAcrossSd),
    between(Landmark::kRightShoulder, Landmark::kLeftShoulder, kAcrossSd),
    {Landmark::kLeftHip, Landmark::kRightHip, Landmark::kLeftShoulder, Landmark::kRightShoulder,
     0.08},
    {Landmark::kLeftShoulder, Landmark::kRightShoulder, Landmark::kLeftEar, Landmark::kRightEar,
     0.15},
    between(Landmark::kRightEar, Landmark::kLeftEar, kAcrossSd),
    {Landmark::kLeftEar, Landmark::kRightEar, Landmark::kNose, Landmark::kNose, 0.25},
    between(Landmark::kLeftShoulder, Landmark::kLeftElbow, kBoneSd),
    between(Landmark::kRightShoulder, Landmark::kRightElbow, kBoneSd),
    between(Landmark::kLeftElbow, Landmark::kLeftWrist, kBoneSd),
    between(Landmark::kRightElbow, Landmark::kRightWrist, kBoneSd),
    between(Landmark::kLeftWrist, Landmark::kLeftIndex, kHandSd),
    between(Landmark::kRightWrist, Landmark::kRightIndex, kHandSd),
    between(Landmark::kLeftWrist, Landmark::kLeftPinky, kHandSd),
    between(Landmark::kRightWrist, Landmark::kRightPinky, kHandSd),
    between(Landmark::kLeftPinky, Landmark::kLeftIndex, 2.0 * kHandSd),
    between(Landmark::kRightPinky, Landmark::kRightIndex, 2.0 * kHandSd),
    between(Landmark::kLeftHip, Landmark::kLeftKnee, kBoneSd),
    between(Landmark::kRightHip, Landmark::kRightKnee, kBoneSd),
    between(Landmark::kLeftKnee, Landmark::kLeftAnkle, kBoneSd),
    between(Landmark::kRightKnee, Landmark::kRightAnkle, kBoneSd),
    between(Landmark::kLeftAnkle, Landmark::kLeftFootIndex, kFootSd),
    between(Landmark::kRightAnkle, Landmark::kRightFootIndex, kFootSd),
    between(Landmark::kLeftHeel, Landmark::kLeftFootIndex, kFootSd),
    between(Landmark::kRightHeel, Landmark::kRightFootIndex, kFootSd),
    between(Landmark::kLeftAnkle, Landmark::kLeftHeel, 2.0 * kFootSd),
    between(Landmark::kRightAnkle, Landmark::kRightHeel, 2.0 * kFootSd),
}};

}  // namespace dance

// Between which landmarks each length of a body is measured: the mean of two points to the mean of
// two others.
//
// Units/frames: as body_shape.h.
// Ownership:    constants only.
// Threads:      none.
// Failure:      none.
#pragma once

#include <array>

#include "producers/camera/solver/body_shape.h"

namespace dance {

struct LengthSpan {
  Length length;
  Landmark from_a, from_b, to_a, to_b;
};
constexpr LengthSpan span_of(Length length, Landmark from, Landmark to) {
  return {length, from, from, to, to};
}
constexpr std::array kLengthSpans{
    span_of(Length::kShoulders, Landmark::kLeftShoulder, Landmark::kRightShoulder),
    span_of(Length::kHips, Landmark::kLeftHip, Landmark::kRightHip),
    LengthSpan{Length::kTorso, Landmark::kLeftHip, Landmark::kRightHip, Landmark::kLeftShoulder,
               Landmark::kRightShoulder},
    span_of(Length::kUpperArm, Landmark::kLeftShoulder, Landmark::kLeftElbow),
    span_of(Length::kUpperArm, Landmark::kRightShoulder, Landmark::kRightElbow),
    span_of(Length::kLowerArm, Landmark::kLeftElbow, Landmark::kLeftWrist),
    span_of(Length::kLowerArm, Landmark::kRightElbow, Landmark::kRightWrist),
    span_of(Length::kThigh, Landmark::kLeftHip, Landmark::kLeftKnee),
    span_of(Length::kThigh, Landmark::kRightHip, Landmark::kRightKnee),
    span_of(Length::kShank, Landmark::kLeftKnee, Landmark::kLeftAnkle),
    span_of(Length::kShank, Landmark::kRightKnee, Landmark::kRightAnkle),
    span_of(Length::kFoot, Landmark::kLeftHeel, Landmark::kLeftFootIndex),
    span_of(Length::kFoot, Landmark::kRightHeel, Landmark::kRightFootIndex),
    span_of(Length::kEars, Landmark::kLeftEar, Landmark::kRightEar),
};

}  // namespace dance

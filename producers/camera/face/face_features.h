// FaceFeatures: distances of a face's points that expressions are made of, in the head's own frame,
// so that neither the head's turn nor its distance changes them.
//
// Units/frames: the head's frame: x to the dancer's left, y up, z forward; lengths in distances
//               between the outer corners of the eyes. R_CHead turns it into the camera's axes.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      nullopt where the points make no face.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "producers/camera/face/face_landmarks.h"

namespace dance {

// Of the left side where there are two of one kind; the right one is the next.
enum FaceFeature : std::uint8_t {
  kLidGap = 0,           // between the eyelids, over the eye's width
  kLowerLid = 2,         // height of the lower lid over the eye's corners
  kInnerBrow = 4,        // height of the brow's inner end over the eye
  kOuterBrow = 6,        // of its outer part
  kMouthCornerUp = 8,    // height of the mouth's corner under the nose
  kMouthCornerOut = 10,  // how far it is to that side
  kUpperLip = 12,        // height of the upper lip's edge, half way to that side, under the nose
  kLowerLip = 14,        // of the lower lip's, over the chin
  kNoseWing = 16,        // height of the nose's wing under the inner corner of the eye
  kCheek = 18,           // from the cheek to the lower lid
  kChinDown = 20,        // from the nose to the chin
  kChinLeft = 21,        // how far the chin is to the left
  kLipGap = 22,          // between the lips
  kMouthWidth = 23,
  kUpperLipRed = 24,  // what is seen of the upper lip, and of the lower one
  kLowerLipRed = 25,
  kLowerLipUp = 26,  // height of the lower lip's edge under the nose
  kUpperLipUp = 27,
};
constexpr std::size_t kFaceFeatureCount = 28;
using FaceFeatures = std::array<float, kFaceFeatureCount>;

struct CapturedFaceShape {
  Eigen::Quaternionf R_CHead;
  FaceFeatures features{};
  float eyes_px = 0.0f;  // between the outer corners of the eyes: how finely the face is seen
};
std::optional<CapturedFaceShape> shape_of(const FaceLandmarks& face);

}  // namespace dance

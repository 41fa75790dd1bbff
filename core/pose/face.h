// Face: a dancer's expression at one moment: how far each of the 52 expressions of ARKit is shown,
// how the head is turned, and where the eyes look.
//
// Units/frames: weights 0…1; R_PB is the head bone's rotation in its parent, as in
//               core/pose/pose.h; the gaze is relative to the head, radians to the dancer's left
//               and up. Times are of the clock that clock_id names.
// Ownership:    plain values, no heap.
// Threads:      none inside.
// Failure:      is_valid() says whether a face may be used; check it once where bytes come in.
// Source:       names and meaning of the expressions: ARKit, ARFaceAnchor.BlendShapeLocation.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "core/base/time.h"

namespace dance {

enum class Expression : std::uint8_t {
  kBrowDownLeft,
  kBrowDownRight,
  kBrowInnerUp,
  kBrowOuterUpLeft,
  kBrowOuterUpRight,
  kCheekPuff,
  kCheekSquintLeft,
  kCheekSquintRight,
  kEyeBlinkLeft,
  kEyeBlinkRight,
  kEyeLookDownLeft,
  kEyeLookDownRight,
  kEyeLookInLeft,
  kEyeLookInRight,
  kEyeLookOutLeft,
  kEyeLookOutRight,
  kEyeLookUpLeft,
  kEyeLookUpRight,
  kEyeSquintLeft,
  kEyeSquintRight,
  kEyeWideLeft,
  kEyeWideRight,
  kJawForward,
  kJawLeft,
  kJawOpen,
  kJawRight,
  kMouthClose,
  kMouthDimpleLeft,
  kMouthDimpleRight,
  kMouthFrownLeft,
  kMouthFrownRight,
  kMouthFunnel,
  kMouthLeft,
  kMouthLowerDownLeft,
  kMouthLowerDownRight,
  kMouthPressLeft,
  kMouthPressRight,
  kMouthPucker,
  kMouthRight,
  kMouthRollLower,
  kMouthRollUpper,
  kMouthShrugLower,
  kMouthShrugUpper,
  kMouthSmileLeft,
  kMouthSmileRight,
  kMouthStretchLeft,
  kMouthStretchRight,
  kMouthUpperUpLeft,
  kMouthUpperUpRight,
  kNoseSneerLeft,
  kNoseSneerRight,
  kTongueOut,
};
constexpr std::size_t kExpressionCount = 52;
constexpr std::size_t index_of(Expression e) { return static_cast<std::size_t>(e); }

// As ARKit writes them, with a small letter in front.
constexpr std::array<const char*, kExpressionCount> kExpressionNames{
    "browDownLeft",      "browDownRight",      "browInnerUp",         "browOuterUpLeft",
    "browOuterUpRight",  "cheekPuff",          "cheekSquintLeft",     "cheekSquintRight",
    "eyeBlinkLeft",      "eyeBlinkRight",      "eyeLookDownLeft",     "eyeLookDownRight",
    "eyeLookInLeft",     "eyeLookInRight",     "eyeLookOutLeft",      "eyeLookOutRight",
    "eyeLookUpLeft",     "eyeLookUpRight",     "eyeSquintLeft",       "eyeSquintRight",
    "eyeWideLeft",       "eyeWideRight",       "jawForward",          "jawLeft",
    "jawOpen",           "jawRight",           "mouthClose",          "mouthDimpleLeft",
    "mouthDimpleRight",  "mouthFrownLeft",     "mouthFrownRight",     "mouthFunnel",
    "mouthLeft",         "mouthLowerDownLeft", "mouthLowerDownRight", "mouthPressLeft",
    "mouthPressRight",   "mouthPucker",        "mouthRight",          "mouthRollLower",
    "mouthRollUpper",    "mouthShrugLower",    "mouthShrugUpper",     "mouthSmileLeft",
    "mouthSmileRight",   "mouthStretchLeft",   "mouthStretchRight",   "mouthUpperUpLeft",
    "mouthUpperUpRight", "noseSneerLeft",      "noseSneerRight",      "tongueOut"};

// Bits of Face::presence.
constexpr std::uint32_t kFaceSeen = 1, kGazeSeen = 2;
constexpr float kMostGaze_rad = 1.6f;

struct Face {
  std::array<float, kExpressionCount> weight{};
  Eigen::Quaternionf R_PB = Eigen::Quaternionf::Identity();
  std::array<float, 2> gaze_rad{};
  std::uint32_t presence = 0;
  std::uint32_t sequence = 0;
  std::uint64_t clock_id = 0;
  MonoTime capture_time;

  float& operator[](Expression e) { return weight[index_of(e)]; }
  float operator[](Expression e) const { return weight[index_of(e)]; }
};

// Weights within 0…1, the head's rotation of unit length (within 1 %), a gaze that eyes have.
inline bool is_valid(const Face& face) {
  for (const float weight : face.weight)
    if (!(weight >= 0.0f && weight <= 1.0f)) return false;
  for (const float angle : face.gaze_rad)
    if (!(std::abs(angle) <= kMostGaze_rad)) return false;
  const float n = face.R_PB.squaredNorm();
  return n > 0.98f && n < 1.02f;
}
inline void normalize(Face& face) { face.R_PB.normalize(); }

}  // namespace dance

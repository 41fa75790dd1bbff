// HandLandmarks: the hand network's 21 landmarks of one hand in one picture, in pixels and in
// metres.
//
// Units/frames: pixels as in producers/camera/body_landmarks.h (z in the same scale, smaller is
//               nearer, 0 at the wrist); world points in metres, axes of the camera (x right, y
//               down, z away), origin in the middle of the hand.
// Ownership:    plain values, no heap.
// Threads:      none inside.
// Failure:      `found` is false where no hand was detected; the rest is then not valid.
// Source:       order and meaning of the points: MediaPipe Hands (model card).
#pragma once

#include "producers/camera/body_landmarks.h"

namespace dance {

enum class HandSide : std::uint8_t { kLeft, kRight };  // the dancer's own

// From a finger's first point the others follow towards its tip: thumb 1 to 4, index finger 5 to 8,
// and so on.
enum HandPoint : std::uint8_t {
  kHandWrist = 0,
  kHandThumb = 1,
  kHandIndex = 5,
  kHandMiddle = 9,
  kHandRing = 13,
  kHandLittle = 17,
};
constexpr std::size_t kHandPointCount = 21;

struct HandLandmarks {
  bool found = false;
  float presence = 0.0f;  // 0…1
  MonoTime capture_time;
  BodyRegion region;
  std::array<Eigen::Vector3f, kHandPointCount> image_px;
  std::array<Eigen::Vector3f, kHandPointCount> world_m;

  // 0…1: how much the points can be relied on. A hand that is half hidden or blurred has a palm
  // and fingers that turn from picture to picture.
  float trust() const {
    constexpr float kNone = 0.5f, kFull = 0.95f;
    const float share = (presence - kNone) / (kFull - kNone);
    return share < 0.0f ? 0.0f : share > 1.0f ? 1.0f : share;
  }
};

}  // namespace dance

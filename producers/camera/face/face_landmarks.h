// FaceLandmarks: the face network's 468 landmarks of one face in one picture.
//
// Units/frames: pixels as in producers/camera/body_landmarks.h (z in the same scale, smaller is
//               nearer). Left and right are the dancer's own.
// Ownership:    plain values, no heap.
// Threads:      none inside.
// Failure:      `found` is false where no face was detected; the rest is then not valid.
// Source:       order and meaning of the points: MediaPipe Face Mesh (model card).
#pragma once

#include "producers/camera/body_landmarks.h"

namespace dance {

constexpr std::size_t kFacePointCount = 468;

struct FaceLandmarks {
  bool found = false;
  float presence = 0.0f;  // 0…1
  MonoTime capture_time;
  BodyRegion region;
  std::array<Eigen::Vector3f, kFacePointCount> image_px;
};

}  // namespace dance

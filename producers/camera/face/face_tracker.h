// FaceTracker: the points of a dancer's face from picture to picture. Where the face is comes from
// the body and the detector; as long as it stays the same face, from its points in the picture
// before.
//
// Units/frames: as producers/camera/face/face_landmarks.h says.
// Ownership:    refers to the networks, which all dancers share and which must outlive it; no heap.
// Threads:      one owner.
// Failure:      a face that is turned away, or too small to be one, has found == false.
// Source:       the order of steps: the graphs of @mediapipe/holistic 0.5.1675471629.
#pragma once

#include "producers/camera/face/face_network.h"
#include "producers/camera/frame.h"

namespace dance {

class FaceTracker {
 public:
  explicit FaceTracker(FaceNetworks& networks) : networks_(&networks) {}

  // `body` is of the same picture.
  const FaceLandmarks& look(const Frame& frame, const BodyLandmarks& body);
  // Another dancer, or another camera.
  void reset() { face_.found = false; }

 private:
  FaceNetworks* networks_;
  FaceLandmarks face_;
};

}  // namespace dance

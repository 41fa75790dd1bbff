// HandTracker: the points of a dancer's hands from picture to picture. Where a hand is comes from
// the body; as long as it stays the same hand, from its points in the last picture.
//
// Units/frames: as producers/camera/hands/hand_landmarks.h says.
// Ownership:    refers to the networks, which all dancers share and which must outlive it; no heap.
// Threads:      one owner.
// Failure:      a hand that is hidden, or too small to be one, has found == false.
// Source:       the order of steps: the graphs of @mediapipe/holistic 0.5.1675471629.
#pragma once

#include <array>

#include "producers/camera/frame.h"
#include "producers/camera/hands/hand_network.h"

namespace dance {

class HandTracker {
 public:
  explicit HandTracker(HandNetworks& networks) : networks_(&networks) {}

  // `body` is of the same picture.
  const HandLandmarks& look(const Frame& frame, const BodyLandmarks& body, HandSide side);
  // The last one of that side.
  const HandLandmarks& hand(HandSide side) const { return hands_[static_cast<std::size_t>(side)]; }
  // Another dancer, or another camera.
  void reset() { hands_ = {}; }

 private:
  HandNetworks* networks_;
  std::array<HandLandmarks, 2> hands_;
};

}  // namespace dance

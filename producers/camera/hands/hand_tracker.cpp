#include "producers/camera/hands/hand_tracker.h"

#include <opencv2/core/mat.hpp>

#include "producers/camera/hands/hand_region.h"

namespace dance {
namespace {

// A hand of fewer pixels has no fingers.
constexpr float kLeastHand_px = 16.0f;

}  // namespace

const HandLandmarks& HandTracker::look(const Frame& frame, const BodyLandmarks& body,
                                       HandSide side) {
  HandLandmarks& hand = hands_[static_cast<std::size_t>(side)];
  const bool was_found = hand.found;
  hand.found = false;
  hand.capture_time = frame.capture_time;
  if (frame.image.type() != CV_8UC3 || frame.image.empty()) return hand;
  const auto searched = hand_region_of(body, side);
  if (!searched || searched->side_px < kLeastHand_px) return hand;
  auto region = networks_->recrop(frame.image, *searched);
  if (!region) return hand;
  if (was_found) {
    const BodyRegion around = hand_region_around(hand.image_px);
    if (is_same_hand(hand.image_px, around, *region)) region = around;
  }
  if (region->side_px >= kLeastHand_px) networks_->look(frame.image, *region, hand);
  return hand;
}

}  // namespace dance

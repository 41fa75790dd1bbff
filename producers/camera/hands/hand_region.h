// Where a hand is looked for: from the body's points, from what the re-crop network says of that,
// and from the hand's points in the last picture.
//
// Units/frames: pixels as in producers/camera/body_landmarks.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      nullopt where the body does not show that hand.
// Source:       the formulas and their numbers: the graphs of @mediapipe/holistic 0.5.1675471629.
#pragma once

#include <optional>
#include <span>

#include "producers/camera/hands/hand_landmarks.h"

namespace dance {

// In which the re-crop network searches.
std::optional<BodyRegion> hand_region_of(const BodyLandmarks& body, HandSide side);
// Two points that the re-crop network gives in the region: the middle, and where the edge is.
BodyRegion hand_region_between(const BodyRegion& searched, const Eigen::Vector2f& middle,
                               const Eigen::Vector2f& edge);
// In which a hand with these points is next.
BodyRegion hand_region_around(std::span<const Eigen::Vector3f, kHandPointCount> image_px);
// Whether the hand of the last picture, whose points these are, is the one in `recrop`.
bool is_same_hand(std::span<const Eigen::Vector3f, kHandPointCount> image_px,
                  const BodyRegion& around, const BodyRegion& recrop);

}  // namespace dance

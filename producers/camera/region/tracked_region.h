// Regions that follow a part of the body from picture to picture: whether what was seen in the last
// picture is what a detector finds in this one.
//
// Units/frames: pixels as in producers/camera/body_landmarks.h; y points down, angles are
//               clockwise.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
// Source:       the tracking of regions in the graphs of @mediapipe/holistic 0.5.1675471629.
#pragma once

#include <span>

#include "producers/camera/body_landmarks.h"

namespace dance {

// What a region may differ from the one that was found, in its sides; and how far points of the
// last picture may lie outside that.
struct TrackingLimits {
  float turn_rad, move, growth, margin;
};
bool is_same_part(std::span<const Eigen::Vector3f> image_px, const BodyRegion& around,
                  const BodyRegion& found, const TrackingLimits& limits);

}  // namespace dance

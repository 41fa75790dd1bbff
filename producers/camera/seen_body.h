// A body's points as formats/camera_view has them: without OpenCV, in shares of the picture.
//
// Units/frames: pixels in, shares out; points far outside are cut to kFarthestPoint pictures.
// Ownership:    plain function.
// Threads:      any; pure.
// Failure:      none.
#pragma once

#include <algorithm>
#include <opencv2/core/types.hpp>

#include "formats/camera_view/camera_view.h"
#include "producers/camera/body_landmarks.h"

namespace dance {

inline SeenBody2d seen_body(const BodyLandmarks& body, const cv::Size& picture) {
  static_assert(kSeenPoints == kLandmarkCount);
  SeenBody2d seen;
  seen.is_found = body.found;
  if (!body.found) return seen;
  const auto share = [](float px, int size) {
    return std::clamp(px / static_cast<float>(size), -kFarthestPoint, kFarthestPoint);
  };
  for (std::size_t i = 0; i < kSeenPoints; ++i)
    seen.points[i] = {share(body.image_px[i].x(), picture.width),
                      share(body.image_px[i].y(), picture.height),
                      std::clamp(body.visibility[i], 0.0f, 1.0f)};
  return seen;
}

}  // namespace dance

#include "producers/camera/face/face_tracker.h"

#include <opencv2/core/mat.hpp>

#include "producers/camera/face/face_region.h"

namespace dance {
namespace {

// A face of fewer pixels has no expression.
constexpr float kLeastSeen_px = 16.0f;

}  // namespace

const FaceLandmarks& FaceTracker::look(const Frame& frame, const BodyLandmarks& body) {
  const bool was_found = face_.found;
  face_.found = false;
  face_.capture_time = frame.capture_time;
  if (frame.image.type() != CV_8UC3 || frame.image.empty()) return face_;
  const auto searched = face_region_of(body);
  if (!searched || searched->side_px < kLeastSeen_px) return face_;
  auto region = networks_->find(frame.image, *searched);
  if (!region) return face_;
  if (was_found) {
    const BodyRegion around = face_region_around(face_.image_px);
    if (is_same_face(face_.image_px, around, *region)) region = around;
  }
  if (region->side_px >= kLeastSeen_px) networks_->look(frame.image, *region, face_);
  return face_;
}

}  // namespace dance

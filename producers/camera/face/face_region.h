// Where a face is looked for: from the body's points, from what the detector finds there, and from
// the face's points in the last picture.
//
// Units/frames: pixels as in producers/camera/body_landmarks.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      nullopt where the body shows no face.
// Source:       the formulas and their numbers: the graphs of @mediapipe/holistic 0.5.1675471629.
#pragma once

#include <optional>
#include <span>

#include "producers/camera/face/face_landmarks.h"

namespace dance {

constexpr std::size_t kDetectedFacePoints = 6;  // right eye, left eye, and four more

std::optional<BodyRegion> face_region_of(const BodyLandmarks& body);
// Points that the detector finds in the region, in its sides.
BodyRegion face_region_of_points(const BodyRegion& searched,
                                 std::span<const Eigen::Vector2f, kDetectedFacePoints> points);
// In which a face with these points is next.
BodyRegion face_region_around(std::span<const Eigen::Vector3f, kFacePointCount> image_px);
// Whether the face of the last picture, whose points these are, is the one that was found.
bool is_same_face(std::span<const Eigen::Vector3f, kFacePointCount> image_px,
                  const BodyRegion& around, const BodyRegion& found);

}  // namespace dance

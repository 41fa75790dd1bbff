// Where the eyes of a face look, by where their dark parts are between the corners: the face
// network has no points of the irises.
//
// Units/frames: radians to the dancer's left and up, in the head; of the eyes at rest the offset is
//               not known.
// Ownership:    reads the picture; allocates nothing.
// Threads:      none inside.
// Failure:      nullopt where both eyes are too small, closed, or out of the picture.
#pragma once

#include <optional>

#include "producers/camera/face/face_landmarks.h"

namespace cv {
class Mat;
}

namespace dance {

// Narrower eyes have too few pixels to tell.
constexpr float kLeastEye_px = 14.0f;

std::optional<Eigen::Vector2f> gaze_of(const cv::Mat& blue_green_red, const FaceLandmarks& face);

}  // namespace dance

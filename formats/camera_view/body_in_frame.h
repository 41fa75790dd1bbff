// BodyInFrame: which parts of a dancer the camera sees, from the points of the body: in the
// picture, cut off by its edge, or hidden behind something.
//
// Units/frames: shares of the picture's width and height. A margin is how far inside of the nearest
//               edge the outermost point of a part lies: below 0 it is outside.
// Ownership:    plain values.
// Threads:      none inside; pure.
// Failure:      where nobody is found nothing of it means anything.
#pragma once

#include "formats/camera_view/camera_view.h"

namespace dance {

struct PartInFrame {
  float margin = 0.0f;
  float visibility = 0.0f;
};

struct BodyInFrame {
  bool is_found = false;
  PartInFrame head;   // the crown too, which is no point of the network: beyond the eyes
  PartInFrame hands;  // the one that is farther out
  PartInFrame knees;  // the better visible one of the two
  PartInFrame feet;   // of each foot its best visible point; of both the one farther out
  // From crown to soles, as if all of the body was seen: from the longest part of it that is.
  float height = 0.0f;
  float centre_x = 0.5f;
  float top_y = 0.0f;     // of the crown
  float bottom_y = 1.0f;  // of the soles
};

BodyInFrame body_in_frame(const SeenBody2d& body);

enum class PartSeen : std::uint8_t { kSeen, kCutOff, kHidden };
// With the limits that a single picture is judged by; over time rather see camera_advice.h.
PartSeen seen(const PartInFrame& part);

}  // namespace dance

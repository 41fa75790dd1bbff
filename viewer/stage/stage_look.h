// What a picture of the stage shows beside its dancers, and how finely it is drawn.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <optional>

#include "core/base/guest_id.h"
#include "viewer/scene/place.h"

namespace dance {

// kLow leaves out antialiasing and mirror images and draws figures with few triangles, for
// computers without a graphics card.
enum class Quality { kLow, kHigh };

// Where the floor fades out, for eyes within it.
struct FloorLimit {
  float x_m = 0.0f, z_m = 0.0f;
  float ends_m = 6.0f;
};

struct StageLook {
  Venue place = Venue::kPlain;
  bool trails = false;  // of the hands
  bool pulse = true;    // the floor shows the beat
  // Which of several stages in one picture: each keeps hair, skirts and trails of its own. The
  // scene's own number is added, so that pictures for others have all stages apart from these.
  int stage = 0;
  // Drawn as that guest sees it: without the guest's own head.
  std::optional<GuestId> through_eyes_of = {};
  // Limits the plain stage's floor. Not set: the floor is as wide as its guests need.
  std::optional<FloorLimit> floor = {};
};

}  // namespace dance

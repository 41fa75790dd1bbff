// AvatarWish: how a guest wants to be drawn, as the house's bus tells it.
//
// Units/frames: colour linear RGB.
// Ownership:    plain value, no allocation.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <array>

#include "core/base/file_hash.h"
#include "core/base/guest_id.h"

namespace dance {

struct AvatarWish {
  GuestId name;  // a look of the mannequin, or a shipped avatar; not set: the display's own
  std::array<float, 3> colour_rgb{1.0f, 1.0f, 1.0f};
  float height_scale = 1.0f;
  FileHash file;  // goes before the name; not set: none
  bool operator==(const AvatarWish&) const = default;
};

}  // namespace dance

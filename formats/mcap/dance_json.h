// Reads the JSON of our MCAP channels: what each schema of formats/mcap/dance_schemas.h says,
// checked.
//
// Units/frames: as the schemas have them.
// Ownership:    fills the caller's values.
// Threads:      none inside.
// Failure:      false where a field is missing, of another type or out of its range; the value is
//               then not to be used.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/base/beat.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance {

// All of a pose but its rotations and place, and the skeleton's one length.
bool read_pose_json(const nlohmann::json& json, Pose& pose, float& hips_height_m);
bool read_hands_json(const nlohmann::json& json, Hands& hands);
bool read_beat_json(const nlohmann::json& json, Beat& beat);
// The rotations and place, and the skeleton but for its hips' height. Every bone must be there, in
// any order, each in its parent.
bool read_transforms_json(const nlohmann::json& json, std::string_view guest, Pose& pose,
                          Skeleton& skeleton);

}  // namespace dance

// Clips, which are files of BVH and glTF, as sources of `dance convert`.
//
// Units/frames: as apps/convert/convert_source.h. A BVH file of ours keeps its heights; in others
//               the feet are put on the floor.
// Ownership:    a source owns its clips.
// Threads:      none inside.
// Failure:      an Error names the file and the cure.
#pragma once

#include "apps/convert/convert_source.h"

namespace dance {

Result<std::unique_ptr<ConvertSource>> open_bvh_input(const std::string& path,
                                                      const GuestId& guest);
Result<std::unique_ptr<ConvertSource>> open_glb_input(const std::string& path,
                                                      const GuestId& guest);

}  // namespace dance

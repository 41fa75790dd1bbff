// Which nodes are the bones of the body: as VRM tells it, else by the names of the nodes (Mixamo,
// Unreal, Unity, Blender, Character Creator, Daz, …), else by the shape of the figure.
//
// Units/frames: none.
// Ownership:    fills bones, fingers and eyes of the model.
// Threads:      none inside.
// Failure:      names the bones that are missing, or that hang from the wrong ones; a bone that may
//               be missing is left out where it hangs wrongly, with a note.
#pragma once

#include "formats/avatar/read/avatar_source.h"

namespace dance {

Result<void> read_bones(AvatarSource& source);

}  // namespace dance

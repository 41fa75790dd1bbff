// What the file tells about itself: its name, its author, and what may be done with it.
//
// Units/frames: none.
// Ownership:    fills name and licence of the model.
// Threads:      none inside.
// Failure:      what is not told is empty; all of it is printable and of bounded length.
// Source:       VRM 1.0 meta, VRM 0.x meta, glTF 2.0 asset.copyright.
#pragma once

#include <string_view>

#include "formats/avatar/read/avatar_source.h"

namespace dance {

void read_licence(AvatarSource& source, std::string_view file_name);

}  // namespace dance

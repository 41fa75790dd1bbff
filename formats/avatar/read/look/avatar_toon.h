// MToon, the look of drawn figures, of either VRM, as far as the project draws it: a lit colour, a
// colour in shade, and where and how sharply one becomes the other.
//
// Units/frames: colours linear.
// Ownership:    changes the material that it is given.
// Threads:      none inside.
// Failure:      a material without MToon stays as it is; numbers are brought into their ranges.
// Source:       VRMC_materials_mtoon 1.0; VRM 0.x materialProperties (colours in sRGB), whose shift
//               and sharpness are brought to those of 1.0.
#pragma once

#include "formats/avatar/read/look/avatar_materials.h"
#include "formats/avatar/read/look/avatar_pictures.h"

namespace dance {

void read_toon(const AvatarSource& source, std::size_t material, AvatarPictures& pictures,
               AvatarMaterial& out, MaterialUv& uv);

}  // namespace dance

// Loads the dancers of a file, whatever its kind: a BVH (plain or packed with xz) holds one, a
// .glb, .vrma, .vrm or .gltf as many as dance in it.
//
// Units/frames: see formats/bvh/retarget.h and formats/gltf/glb.h; a glTF is not moved to the
//               floor, and is taken as metres with +Y up unless the options say otherwise.
// Ownership:    plain values.
// Threads:      none inside; reads the file on the caller's thread.
// Failure:      an Error names the file and the cure. Sizes are bounded.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formats/gltf/glb.h"

namespace dance {

// At least one; of a BVH without a name.
Result<std::vector<NamedClip>> load_dancers(const std::string& path,
                                            const RetargetOptions& options = {});

// The only dancer of a file, or of several the one with this name.
Result<NamedClip> load_dancer(const std::string& path, std::string_view name,
                              const RetargetOptions& options = {});

}  // namespace dance

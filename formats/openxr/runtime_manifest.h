// The manifest by which OpenXR's loader finds a headset's runtime: which file it takes, and whether
// the library that it names is there. Nothing is loaded: a vendor's code is no part of a check.
//
// Threads: any.
// Failure: an Error names the manifest, what is wrong with it, and the cure.
// Source:  OpenXR loader design, "Linux runtime discovery" and "Runtime manifest file format".
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace dance::openxr {

// A variable of the environment; "" where it is not set.
using Environment = std::function<std::string(const char* name)>;
std::string own_environment(const char* name);

// The paths at which the loader looks, in its order; XR_RUNTIME_JSON alone if it is set.
std::vector<std::string> manifest_paths(const Environment& environment);
// The manifest that the loader takes; nullopt if no runtime is active.
std::optional<std::string> active_manifest(const Environment& environment);
// The path of the library that a manifest names; a name without a slash is left to the system's
// search, and not looked for.
Result<std::string> library_of(const std::string& manifest);

}  // namespace dance::openxr

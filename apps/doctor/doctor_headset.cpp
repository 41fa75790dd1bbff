#include "apps/doctor/doctor_headset.h"

namespace dance {
namespace {

#ifdef DANCE_HAVE_XR
constexpr bool kIsBuilt = true;
#else
constexpr bool kIsBuilt = false;
#endif

}  // namespace

Finding check_headset(const openxr::Environment& environment, bool is_built) {
  using enum Finding::Grade;
  if (!is_built)
    return {"headset", kNote, "this build knows none: OpenXR was not there when it was made",
            "./dance setup   (installs and builds what it needs)"};
  const bool is_named = !environment("XR_RUNTIME_JSON").empty();
  if (const auto manifest = openxr::active_manifest(environment)) {
    if (const auto library = openxr::library_of(*manifest); !library)
      return {"headset", kNote, library.error().what,
              is_named ? "unset XR_RUNTIME_JSON" : "ls -l " + *manifest};
    return {"headset", kOk, "an OpenXR runtime is active: " + *manifest, ""};
  }
  if (is_named)
    return {"headset", kNote, "XR_RUNTIME_JSON names a file that is not there",
            "unset XR_RUNTIME_JSON, or name the manifest of the headset's runtime"};
  return {"headset", kNote, "no OpenXR runtime is active; dances without a headset need none",
          "start SteamVR, Monado or WiVRn, and make it the active one in its settings"};
}

Finding check_headset() { return check_headset(openxr::own_environment, kIsBuilt); }

}  // namespace dance

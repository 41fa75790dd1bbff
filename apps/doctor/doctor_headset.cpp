#include "apps/doctor/doctor_headset.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace dance {
namespace {

#ifdef DANCE_HAVE_XR
constexpr bool kIsBuilt = true;
#else
constexpr bool kIsBuilt = false;
#endif

}  // namespace

std::vector<std::string> openxr_manifests(const Environment& environment) {
  if (const std::string named = environment("XR_RUNTIME_JSON"); !named.empty()) return {named};
  std::vector<std::string> folders;
  const std::string own = environment("XDG_CONFIG_HOME"), home = environment("HOME");
  if (!own.empty())
    folders.push_back(own);
  else if (!home.empty())
    folders.push_back(home + "/.config");
  std::string others = environment("XDG_CONFIG_DIRS");
  if (others.empty()) others = "/etc/xdg";
  for (std::size_t from = 0; from < others.size();) {
    const std::size_t colon = std::min(others.find(':', from), others.size());
    if (colon > from) folders.push_back(others.substr(from, colon - from));
    from = colon + 1;
  }
  folders.emplace_back("/etc");
  std::vector<std::string> manifests;
  for (const std::string& folder : folders)
    manifests.push_back(folder + "/openxr/1/active_runtime.json");
  return manifests;
}

Finding check_headset(const Environment& environment, bool is_built) {
  using enum Finding::Grade;
  if (!is_built)
    return {"headset", kNote, "this build knows none: OpenXR was not there when it was made",
            "./dance setup   (installs and builds what it needs)"};
  const auto manifests = openxr_manifests(environment);
  for (const std::string& manifest : manifests) {
    std::error_code error;
    if (std::filesystem::exists(manifest, error))
      return {"headset", kOk, "an OpenXR runtime is active: " + manifest, ""};
  }
  if (!environment("XR_RUNTIME_JSON").empty())
    return {"headset", kNote, "XR_RUNTIME_JSON names a file that is not there",
            "unset XR_RUNTIME_JSON, or name the manifest of the headset's runtime"};
  return {"headset", kNote, "no OpenXR runtime is active; dances without a headset need none",
          "start SteamVR, Monado or WiVRn, and make it the active one in its settings"};
}

Finding check_headset() {
  const Environment environment = [](const char* name) {
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
    return std::string(value != nullptr ? value : "");
  };
  return check_headset(environment, kIsBuilt);
}

}  // namespace dance

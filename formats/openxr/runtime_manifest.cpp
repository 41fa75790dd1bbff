#include "formats/openxr/runtime_manifest.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/program/whole_file.h"

namespace dance::openxr {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostManifest_bytes = std::size_t{1} << 20;
constexpr const char* kCure =
    "; install the headset's runtime again, or make another one active in its settings";

tl::unexpected<Error> wrong(const std::string& manifest, const std::string& what) {
  return fail("OpenXR manifest " + manifest + " " + what + kCure);
}

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

}  // namespace

std::string own_environment(const char* name) {
  const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nobody sets them
  return value != nullptr ? value : "";
}

std::vector<std::string> manifest_paths(const Environment& environment) {
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

std::optional<std::string> active_manifest(const Environment& environment) {
  for (std::string& manifest : manifest_paths(environment))
    if (is_there(manifest)) return std::move(manifest);
  return std::nullopt;
}

Result<std::string> library_of(const std::string& manifest) {
  DANCE_TRY(const std::string text, read_whole_file(manifest, kMostManifest_bytes));
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const auto runtime = json.is_object() ? json.find("runtime") : json.end();
  if (!json.is_object() || runtime == json.end() || !runtime->is_object())
    return wrong(manifest, "is damaged");
  const auto path = runtime->find("library_path");
  if (path == runtime->end() || !path->is_string()) return wrong(manifest, "names no library");
  const fs::path named = path->get<std::string>();
  if (named.empty()) return wrong(manifest, "names no library");
  if (!named.has_parent_path()) return named.string();
  // A relative path counts from the manifest's folder: by its name, or where a link leads to.
  std::error_code error;
  const fs::path target = fs::canonical(manifest, error);
  const fs::path by_name = fs::path(manifest).parent_path() / named;
  const fs::path by_target = target.parent_path() / named;
  if (is_there(by_name)) return by_name.string();
  if (!error && is_there(by_target)) return by_target.string();
  return wrong(manifest, "names a library that is missing: " + by_name.lexically_normal().string());
}

}  // namespace dance::openxr

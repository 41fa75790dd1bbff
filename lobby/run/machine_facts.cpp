#include "lobby/run/machine_facts.h"

#include <unistd.h>

#include <cstdlib>

#include "core/base/printable.h"
#include "core/net/machine_addresses.h"
#include "core/program/child_process.h"
#include "core/program/program.h"
#include "formats/openxr/runtime_manifest.h"
#include "house/avatar_choice.h"
#include "viewer/dance_panel/recording.h"

namespace dance {
namespace {

bool has_program(const char* name) {
  return access((program_folder() + "/" + name).c_str(), X_OK) == 0;
}

}  // namespace

std::string with_tilde(const std::string& path) {
  const char* home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe)
  const std::string folder = home != nullptr ? home : "";
  if (folder.size() > 1 && path.starts_with(folder + "/")) return "~" + path.substr(folder.size());
  return path;
}

void find_parts(LobbyModel& model) {
  model.has_camera = has_program("dance-capture");
  model.has_music = has_program("dance-music");
  model.has_voice = has_program("dance-voice");
  model.has_headset = has_program("dance-headset");
  model.has_server = has_program("dance-server");
  const std::string media = program_folder() + "/../lib/dancegraph/libdance_media.so";
  model.shelf.has_video = access(media.c_str(), R_OK) == 0;
  model.shelf.has_opener = is_in_path("xdg-open");
  model.avatars = shipped_avatars(data_folder() + "/avatars");
}

void find_headset(LobbyModel& model) {
  model.headset_error.clear();
  if (!model.has_headset) return;
  const auto manifest = openxr::active_manifest(openxr::own_environment);
  if (!manifest) {
    model.headset_error = "no OpenXR runtime is active";
    return;
  }
  if (const auto library = openxr::library_of(*manifest); !library)
    model.headset_error = printable(library.error().what);
}

std::vector<std::string> recording_folders() {
  const auto environment = [](const char* name) -> const char* {
    return std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
  };
  std::vector<std::string> folders = older_recordings_folders(environment);
  const std::string first = recordings_folder(environment);
  if (!first.empty()) folders.insert(folders.begin(), first);
  return folders;
}

Result<ChildProcess> open_folder(const std::string& folder) {
  return ChildProcess::start({"xdg-open", {folder}, "/dev/null", "/dev/null"});
}

void find_addresses(LobbyModel& model) { model.host.addresses = machine_addresses(); }

}  // namespace dance

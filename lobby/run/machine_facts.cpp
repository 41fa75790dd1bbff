#include "lobby/run/machine_facts.h"

#include <unistd.h>

#include <cstdlib>

#include "core/net/machine_addresses.h"
#include "core/program/program.h"
#include "house/avatar_choice.h"

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
  model.avatars = shipped_avatars(data_folder() + "/avatars");
}

void find_addresses(LobbyModel& model) { model.host.addresses = machine_addresses(); }

}  // namespace dance

// dance lobby: the window before the dance: who dances, with whom, and in which room.

#include <string>

#include "core/program/program.h"
#include "lobby/run/lobby_run.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance lobby                                   the window; `dance` alone opens it too
  dance join ~/.config/dancegraph/house.toml    what was chosen in it, without it
)";

Result<void> run_lobby(const std::string& settings) {
  std::string path = settings;
  if (path.empty()) {
    DANCE_TRY(path, SettingsFile::usual_path());
  }
  DANCE_TRY(auto lobby, LobbyRun::create(path));
  return lobby->run();
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  std::string settings;
  dance::CommandLine line(
      "The window for dancers: how you are seen, with whom you dance, and a room of your own.",
      "dance lobby");
  line.add("--settings", settings,
           "the session file that it keeps (else house.toml in the folder dancegraph of the user's "
           "settings)");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_lobby(settings); });
}

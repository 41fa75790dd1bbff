// dance lobby: the window before the dance: who dances, with whom, and in which room.

#include <algorithm>
#include <cstring>
#include <string>

#include "core/program/program.h"
#include "lobby/run/lobby_run.h"
#include "tunnel/invitation/invitation.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance lobby                                   the window; `dance` alone opens it too
  dance lobby 'dance://dance.example.org/salsa?…'
                                                shows an invitation, and joins when you confirm
  dance join ~/.config/dancegraph/house.toml    what was chosen in it, without it
)";

// Other users of the machine see command lines: not the key in one.
void hide_invitation(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (is_invitation(argv[i])) std::fill(argv[i], argv[i] + std::strlen(argv[i]), '-');
}

Result<void> run_lobby(const std::string& settings, const std::string& invitation) {
  // Where there is no window to tell it in.
  if (display_name().empty() && !invitation.empty())
    if (const auto read = parse_invitation(invitation); !read)
      return tl::make_unexpected(read.error());
  std::string path = settings;
  if (path.empty()) {
    DANCE_TRY(path, SettingsFile::usual_path());
  }
  DANCE_TRY(auto lobby, LobbyRun::create(path, invitation));
  return lobby->run();
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  std::string settings, invitation;
  dance::CommandLine line(
      "The window for dancers: how you are seen, with whom you dance, and a room of your own.",
      "dance lobby");
  line.add(
      "INVITATION", invitation,
      "dance://…, in quotes: shows its room, server and your name, and joins when you confirm");
  line.add("--settings", settings,
           "the session file that it keeps (else house.toml in the folder dancegraph of the user's "
           "settings)");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] {
    dance::hide_invitation(argc, argv);
    return dance::run_lobby(settings, invitation);
  });
}

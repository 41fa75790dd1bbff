// dance manager: the signal manager of a house as a program of its own: routes, stage, roster;
// producers and link are other programs on the bus.

#include "core/program/program.h"
#include "core/program/talk.h"
#include "house/house.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance manager                          own captures to the stage; remote guests predicted
  dance manager sessions/alice.toml      routes, hosted producers and consumers of a session file
)";

Result<void> run_manager(const std::string& file, const std::string& bus) {
  HouseConfig session;
  session.routes = default_routes();
  if (!file.empty()) {
    DANCE_TRY(session, load_session(file));
  }
  session.server.clear();  // the link is a program of its own here
  if (!bus.empty()) session.bus = bus;
  DANCE_TRY(auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return stops;
  DANCE_TRY(auto house, House::open(session, *poller));
  talk::info("{} routes on {}; Ctrl-C ends it", session.routes.size(), house->bus().url());
  poller->run();
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  std::string file;
  std::string bus;
  dance::CommandLine line(
      "The signal manager of a house: which pose reaches the stage, through which transformers.",
      "dance manager");
  line.add("SESSION", file, "a session file; its server is left to `dance link`");
  line.add("--bus", bus, "LCM URL of the house's bus, instead of the session file's");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_manager(file, bus); });
}

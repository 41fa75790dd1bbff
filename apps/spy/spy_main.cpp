// dance spy: LCM's own inspector with our types, started the way that works on Debian 12 (its
// script passes an option that Java has not known since version 10).

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "core/bus/bus.h"
#include "core/bus/bus_url.h"
#include "core/bus/route/multicast_route.h"
#include "core/program/program.h"
#include "core/program/talk.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance spy                                        the house's bus; a double click opens a channel
  dance spy --bus 'udpm://239.255.76.67:7668?ttl=0'
  dance spy --print                                the command, for a script of your own
lcm-spy needs a multicast route over lo. It also receives from the network, and datagrams from
there can crash it. What it sends with ttl=0 may leave through a VPN. `dance doctor` prints the
commands for the route, and for a firewall rule that closes the port of the bus.
)";

constexpr const char* kInstall =
    "apt-get install liblcm-java libjchart2d-java default-jre default-jdk-headless";

bool is_on_path(const std::string& program) {
  const char* path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): one thread
  std::string folders = path ? path : "/usr/bin:/bin";
  for (std::size_t begin = 0; begin <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', begin), folders.size());
    if (access((folders.substr(begin, end - begin) + "/" + program).c_str(), X_OK) == 0)
      return true;
    begin = end + 1;
  }
  return false;
}

Result<std::vector<std::string>> spy_command(const std::string& bus) {
  const std::string types = data_folder() + "/dance_types.jar";
  if (!is_on_path("java"))
    return fail("java is missing; install it with: " + std::string(kInstall));
  std::string class_path;
  for (const std::string& jar : {std::string("/usr/share/java/lcm.jar"),
                                 std::string("/usr/share/java/jchart2d.jar"), types}) {
    if (!std::filesystem::exists(jar))
      return fail(jar + " is missing; install it with: " + std::string(kInstall) +
                  " (and, in the source tree, build again: ./dance spy does both)");
    class_path += (class_path.empty() ? "" : ":") + jar;
  }
  return std::vector<std::string>{"java",        "-Djava.net.preferIPv4Stack=true",
                                  "-cp",         class_path,
                                  "lcm.spy.Spy", "--lcm-url=" + bus};
}

// Java receives from the device of the multicast route alone, and the house sends over lo.
Result<void> check_route(const std::string& url) {
  DANCE_TRY(const BusAddress address, parse_udpm_url(url));
  if (const std::string device = multicast_device(address.group); device != "lo")
    talk::warn("lcm-spy will not receive the house: multicast has {}; give it one with: {}",
               device.empty() ? "no route" : "its route over " + device, kMulticastCure);
  return {};
}

Result<void> run_spy(const std::string& bus, bool print) {
  const std::string url = bus_url_or_default(bus);
  if (auto checked = check_route(url); !checked) return checked;
  DANCE_TRY(auto command, spy_command(url));
  if (print) {
    for (const std::string& word : command) std::printf("'%s' ", word.c_str());
    std::printf("\n");
    return {};
  }
  const char* display = std::getenv("DISPLAY");  // NOLINT(concurrency-mt-unsafe): one thread
  if (!display || !*display)
    return fail(
        "there is no display (DISPLAY is not set); in a terminal, `dance top` shows the channels");
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp("java", arguments.data());
  return fail(std::string("java cannot be run: ") +
              std::strerror(errno));  // NOLINT(concurrency-mt-unsafe)
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  std::string bus;
  bool print = false;
  dance::CommandLine line("lcm-spy with our message types.", "dance spy");
  line.add("--bus", bus, "LCM URL of the bus to look at");
  line.add_flag("--print", print, "print the command instead of running it");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_spy(bus, print); });
}

// dance-top: channels and programs of a bus in a terminal, anew every second.

#include <unistd.h>

#include <cstdio>

#include "apps/bus_program.h"
#include "apps/top/top_table.h"
#include "core/net/mono_clock.h"
#include "core/program/program.h"

namespace dance {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  dance top                            this house's bus, until ctrl-C\n"
    "  dance top --once                     one table after a second and a half\n"
    "  dance top --bus 'udpm://239.255.76.67:7668?ttl=0' --seconds 10\n";
// Longer than a period of what is sent once a second: skeletons, counters.
constexpr Duration kListensOnce = Duration::ms(1500);
constexpr const char* kClearScreen = "\033[H\033[2J";

struct Options {
  std::string bus_url;
  double seconds = 0.0;
  bool is_once = false;
};

Result<void> watch(const Options& options) {
  DANCE_TRY(BusProgram program, BusProgram::open(options.bus_url));
  TopTable table;
  program.bus().on_anything(
      [&](std::string_view channel, const void* data, std::size_t size, MonoTime now) {
        table.take(channel, {static_cast<const std::uint8_t*>(data), size}, now);
      });
  const bool is_terminal = isatty(STDOUT_FILENO) == 1 && !options.is_once;
  program.every(options.is_once ? kListensOnce : Duration::s(1), [&](MonoTime now) {
    const std::string text = table.text(now);
    std::printf("%s%s\n%s\n", is_terminal ? kClearScreen : "", program.bus().url().c_str(),
                text.c_str());
    const bool is_written = std::fflush(stdout) == 0;
    // The reader of a pipe (head, less) may have ended.
    if (options.is_once || !is_written) program.poller().stop();
  });
  program.stop_after(options.seconds);
  program.run();
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Options options;
  dance::CommandLine line("Channels and programs of a bus: rate, bytes, type, age.", "dance top");
  line.add("--bus", options.bus_url, "LCM URL of the bus");
  line.add("--seconds", options.seconds, "stop after so long (0: ctrl-C)").range(0.0, 1e7);
  line.add_flag("--once", options.is_once, "one table after a second and a half, then end");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::watch(options); });
}

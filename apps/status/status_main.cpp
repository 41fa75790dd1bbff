// dance status: rooms and guests of a server on this machine, in a terminal, anew every second.

#include <unistd.h>

#include <cstdio>

#include "apps/status/cluster_table.h"
#include "apps/status/log_table.h"
#include "apps/status/status_source.h"
#include "apps/status/status_table.h"
#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/program/program.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  dance status                         the server on port 7400, until ctrl-C\n"
    "  dance status --once                  one table, then end\n"
    "  dance status --cluster               the other servers of its cluster too\n"
    "  dance status --log                   who joined, who was refused, who was removed\n"
    "  dance status --port 7500 --once --json | jq '.rooms[].guests'\n";
constexpr const char* kClearScreen = "\033[H\033[2J";

struct StatusOptions {
  std::uint16_t port = kDefaultServerPort;
  bool is_once = false;
  bool is_json = false;
  bool with_cluster = false;
  bool shows_log = false;
};

Result<void> show_log(const StatusOptions& options) {
  DANCE_TRY(const std::string lines, ask_server_log(options.port));
  std::printf("%s", options.is_json ? log_json(lines).c_str() : log_text(lines).c_str());
  return {};
}

Result<void> show(const StatusOptions& options) {
  const bool is_screen = isatty(STDOUT_FILENO) == 1 && !options.is_once && !options.is_json;
  DANCE_TRY(auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return stops;
  Result<void> ended;
  poller->add_timer(mono_now(), [&](MonoTime now) {
    const auto status = ask_server(options.port);
    if (!status) {
      ended = tl::make_unexpected(status.error());
      poller->stop();
      return MonoTime();
    }
    if (options.with_cluster && !status->contains("cluster")) {
      ended = fail("the server on port " + std::to_string(options.port) +
                   " is in no cluster: it was started without --cluster");
      poller->stop();
      return MonoTime();
    }
    if (options.is_json)
      std::printf(
          "%s\n",
          status->dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
    else
      std::printf("%s%s%s%s", is_screen ? kClearScreen : "", status_text(*status).c_str(),
                  options.with_cluster ? cluster_text(*status).c_str() : "",
                  options.is_once ? "" : "\n");
    const bool is_written = std::fflush(stdout) == 0;
    // The reader of a pipe (head, less) may have ended.
    if (options.is_once || !is_written) poller->stop();
    return now + Duration::s(1);
  });
  poller->run();
  return ended;
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::StatusOptions options;
  dance::CommandLine line(
      "Rooms and guests of a server on this machine: round trips, jitter, losses, bytes; and what "
      "it refused.",
      "dance status");
  line.add("--port", options.port, "UDP port of the server").range(1, 65535).shows_default();
  line.add_flag("--once", options.is_once, "once, then end");
  line.add_flag("--cluster", options.with_cluster,
                "the cluster too: NATS, its servers, and what passes between them");
  line.add_flag("--log", options.shows_log,
                "the audit log: joins, refusals and removals, also of earlier runs; then end");
  line.add_flag("--json", options.is_json, "as JSON, one object a line");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] {
    return options.shows_log ? dance::show_log(options) : dance::show(options);
  });
}

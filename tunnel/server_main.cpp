// dance server: where the houses' links meet.

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/net/mono_clock.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "tunnel/server.h"
#include "tunnel/server_watch.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance server                                  for houses on this machine, on port 7400
  dance server --bind 0.0.0.0 --port 7400       for houses elsewhere (unencrypted for now: trusted networks only)
  dance server --metrics 127.0.0.1:9464         a page for Prometheus at /metrics
  dance server --json > summary.json            what it did, when it is ended with Ctrl-C
While it runs, `dance status` on the same machine shows its rooms and guests.
)";

constexpr Duration kSecond = Duration::s(1);
constexpr int kSecondsPerStatus = 10;

struct ServerOptions {
  std::string bind = "127.0.0.1";
  std::uint16_t port = kDefaultServerPort;
  ServerLimits limits;
  double share_ms = -1.0;  // < 0: by the room
  std::string metrics;
  bool json = false;
};

nlohmann::ordered_json summary(const Server& server, Duration uptime) {
  const ServerCounters& c = server.core().counters();
  const UdpSocket::Counters& socket = server.socket_counters();
  nlohmann::ordered_json rejected = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < kServerRejects; ++i)
    rejected[std::string(kServerRejectNames[i])] = c.rejected[i];
  return {{"seconds", uptime.as_seconds()},
          {"datagrams_in", c.datagrams_in},
          {"datagrams_out", c.datagrams_out},
          {"bytes_in", c.bytes_in},
          {"bytes_out", c.bytes_out},
          {"records_in", c.records_in},
          {"records_out", c.records_out},
          {"datagrams_acked", c.datagrams_acked},
          {"key_frames_wanted", c.key_frames_wanted},
          {"key_frames_asked", c.key_frames_asked},
          {"sessions_begun", c.sessions_begun},
          {"sessions_resumed", c.sessions_resumed},
          {"sessions_timed_out", c.sessions_timed_out},
          {"goodbyes", c.goodbyes},
          {"send_failed", socket.send_failed},
          {"truncated", socket.truncated},
          {"rejected", rejected}};
}

// At most one line a second for each cause.
void log_rejects(const ServerCounters& before, const ServerCounters& after) {
  for (std::size_t i = 0; i < kServerRejects; ++i)
    if (after.rejected[i] != before.rejected[i])
      talk::warn("{} dropped: {}", after.rejected[i] - before.rejected[i], kServerRejectNames[i]);
}

void log_status(const Server& server, const ServerCounters& before) {
  const ServerCore& core = server.core();
  const ServerCounters& c = core.counters();
  talk::info("{} rooms, {} links, {} guests; in the last {} s {} records in, {} out, {} kB out",
             core.room_count(), core.session_count(), core.guest_count(), kSecondsPerStatus,
             c.records_in - before.records_in, c.records_out - before.records_out,
             (c.bytes_out - before.bytes_out) / 1000);
}

Result<void> run_server(const ServerOptions& options) {
  DANCE_TRY(auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return stops;
  DANCE_TRY(Address local, Address::resolve(options.bind, options.port));
  ServerLimits limits = options.limits;
  if (options.share_ms >= 0.0) limits.share_window = Duration::seconds(options.share_ms * 1e-3);
  DANCE_TRY(auto server, Server::open(local, limits, *poller));
  local = server->local_address();
  ServerWatch::Options shown;
  shown.address = local;
  shown.limits = limits;
  shown.metrics = options.metrics;
  shown.peer_text = [](const ServerSession& session) { return session.address.to_string(); };
  DANCE_TRY(auto watch, ServerWatch::open(server->core(), shown, *poller));
  talk::info("hears on {}; Ctrl-C ends it", local.to_string());
  if (!local.is_loopback())
    talk::warn(
        "sessions are not encrypted yet: bind beyond this machine only on a network that "
        "you trust");

  const MonoTime begin = mono_now();
  ServerCounters last_second;
  ServerCounters last_status;
  int seconds = 0;
  poller->add_timer(begin + kSecond, [&](MonoTime now) {
    log_rejects(last_second, server->core().counters());
    last_second = server->core().counters();
    if (++seconds % kSecondsPerStatus == 0) {
      if (last_second.datagrams_in != last_status.datagrams_in) log_status(*server, last_status);
      last_status = last_second;
    }
    return now + kSecond;
  });
  poller->run();

  watch->say_stopping();
  server->say_goodbye();
  const auto report = summary(*server, mono_now() - begin);
  if (options.json)
    std::printf("%s\n", report.dump().c_str());
  else
    talk::info("{} records in, {} out, {} datagrams dropped", server->core().counters().records_in,
               server->core().counters().records_out, server->core().counters().rejected_total());
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::ServerOptions options;
  dance::CommandLine line(
      "The tunnel's server: forwards each guest's newest pose to everybody in the room.",
      "dance server");
  line.add("--port", options.port, "UDP port").range(1, 65535).shows_default();
  line.add("--bind", options.bind,
           "address to hear on: 127.0.0.1 = this machine only, 0.0.0.0 or :: = everywhere")
      .shows_default();
  line.add("--max-sessions", options.limits.sessions, "links at a time")
      .range(1, 10'000)
      .shows_default();
  line.add("--max-rooms", options.limits.rooms, "rooms at a time").range(1, 10'000).shows_default();
  line.add("--max-guests", options.limits.guests_per_room, "guests in a room")
      .range(1, static_cast<int>(dance::wire::kMaxGuestsPerRoom))
      .shows_default();
  line.add(
          "--share-ms", options.share_ms,
          "how long a pose waits for others to share a datagram with: more saves bytes, 0 = not at "
          "all (else 0 for up to 8 guests, then more, to 5 for 28)")
      .range(0, 20);
  line.add("--metrics", options.metrics,
           "HOST:PORT of a page of metrics for Prometheus; none unless asked for");
  line.add_flag("--json", options.json, "write a summary to stdout at the end");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_server(options); });
}

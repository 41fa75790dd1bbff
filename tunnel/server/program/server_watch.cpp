#include "tunnel/server/program/server_watch.h"

#include "core/net/mono_clock.h"
#include "core/program/talk.h"

namespace dance {
namespace {

constexpr Duration kWatchPeriod = Duration::s(1);

}  // namespace

std::string status_socket_name(std::uint16_t port) {
  return "server-" + std::to_string(port) + ".sock";
}

Result<std::unique_ptr<ServerWatch>> ServerWatch::open(const ServerCore& core,
                                                       const Options& options, Poller& poller) {
  std::unique_ptr<ServerWatch> watch(new ServerWatch(core, options, poller));
  if (!options.metrics.empty()) {
    if (!ServerMetrics::is_built())
      return fail(
          "--metrics: this server was built without Prometheus: apt-get install "
          "prometheus-cpp-dev, and build it again");
    DANCE_TRY(const Address address, Address::resolve(options.metrics, kDefaultMetricsPort));
    DANCE_TRY(watch->metrics_, ServerMetrics::open(address));
    watch->metrics_->show(watch->status(mono_now()));
    const Address heard = address.with_port(watch->metrics_->port());
    talk::info("metrics at http://{}/metrics", heard.to_string());
    if (!heard.is_loopback())
      talk::warn("metrics: all who reach {} see who dances in which room", heard.to_string());
  }
  const std::string path = local_socket_folder() + "/" + status_socket_name(options.address.port());
  auto socket = LocalTextServer::open(
      path, [watch = watch.get()](MonoTime now) { return to_json(watch->status(now)) + "\n"; },
      poller);
  if (socket)
    watch->socket_ = std::move(*socket);
  else
    talk::warn("`dance status` will not see this server: {}", socket.error().what);
  watch->service_.say_ready();
  return watch;
}

ServerWatch::ServerWatch(const ServerCore& core, const Options& options, Poller& poller)
    : poller_(poller),
      handshakes_(options.handshakes),
      cluster_(options.cluster),
      to_session_(options.to_session),
      maker_(core, options.limits, options.address.to_string(), options.peer_text,
             session_time(mono_now())) {
  const MonoTime begin = mono_now();
  second_ = poller_.add_timer(begin + kWatchPeriod, [this](MonoTime now) {
    maker_.sample(session_time(now));
    if (metrics_) metrics_->show(status(now));
    return now + kWatchPeriod;
  });
  const Duration period = service_.alive_period();
  alive_ = poller_.add_timer(period > Duration() ? begin + period : MonoTime(),
                             [this, period](MonoTime now) {
                               service_.say_alive();
                               return now + period;
                             });
}

ServerWatch::~ServerWatch() {
  poller_.set_deadline(second_, MonoTime());
  poller_.set_deadline(alive_, MonoTime());
}

ServerStatus ServerWatch::status(MonoTime now) const {
  const std::vector<NamedCount> handshakes =
      handshakes_ ? handshakes_() : std::vector<NamedCount>();
  ServerStatus status = maker_.make(session_time(now), handshakes);
  if (cluster_) status.cluster = cluster_(now);
  return status;
}

}  // namespace dance

// dance lossy: a UDP proxy that is a bad line.

#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/net/lossy_proxy.h"
#include "core/program/program.h"
#include "core/program/talk.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance lossy --link 'delay=80ms jitter=10ms loss=1%'        then: dance link --server 127.0.0.1:7401 …
  dance lossy --link 'loss=2% burst=4 dup=0.1% reorder=1% rate=1Mbit queue=50ms seed=7'
  dance lossy --trace starlink_a_rtt.csv.xz --json           counts at the end, on stdout
)";

struct LossyOptions {
  std::string listen = "127.0.0.1:7401";
  std::string to = "127.0.0.1:7400";
  std::string link;
  std::string trace;
  bool json = false;
};

nlohmann::ordered_json account(const LossyProxy& proxy, LossyProxy::Direction direction) {
  const LossyProxy::Totals totals = proxy.totals(direction);
  return {{"offered", totals.line.offered},     {"forwarded", totals.line.forwarded},
          {"lost", totals.line.lost},           {"queue_dropped", totals.line.queue_dropped},
          {"overflow", totals.overflow},        {"duplicated", totals.line.duplicated},
          {"reordered", totals.line.reordered}, {"delivered", totals.delivered}};
}

Result<void> run_lossy(const LossyOptions& options) {
  DANCE_TRY(const LossySpec spec, LossySpec::parse(options.link));
  std::optional<DelayTrace> trace;
  if (!options.trace.empty()) {
    DANCE_TRY(trace, DelayTrace::load(options.trace));
  }
  DANCE_TRY(const Address listen, Address::resolve(options.listen));
  DANCE_TRY(const Address target, Address::resolve(options.to));
  DANCE_TRY(auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return stops;
  DANCE_TRY(auto proxy, LossyProxy::open(listen, target, spec, trace ? &*trace : nullptr, *poller));
  talk::info("{} to {} and back, each way: {}{}", proxy->local_address().to_string(),
             target.to_string(), options.link.empty() ? "no delay, no loss" : options.link,
             options.trace.empty() ? "" : ", trace " + options.trace);
  poller->run();

  const auto up = account(*proxy, LossyProxy::Direction::kUp);
  const auto down = account(*proxy, LossyProxy::Direction::kDown);
  const nlohmann::ordered_json report{
      {"clients", proxy->client_count()}, {"up", up}, {"down", down}};
  if (options.json)
    std::printf("%s\n", report.dump().c_str());
  else
    talk::info("{}", report.dump());
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::LossyOptions options;
  dance::CommandLine line(
      "A bad line between links and a server: delay, jitter, loss, bursts, copies, "
      "reordering, a rate, or a recorded trace; each direction by itself.",
      "dance lossy");
  line.add("--listen", options.listen, "where links send to").shows_default();
  line.add("--to", options.to, "the server").shows_default();
  line.add("--link", options.link,
           "delay=80ms jitter=10ms loss=1% burst=3 dup=0.1% reorder=1% rate=1Mbit "
           "queue=50ms seed=1")
      .check([](const std::string& text) {
        const auto spec = dance::LossySpec::parse(text);
        return spec ? std::string() : spec.error().what;
      });
  line.add("--trace", options.trace,
           "CSV (or .xz) of t_ms or t_s with owd_var_ms or rtt_ms; comes on top of --link");
  line.add_flag("--json", options.json, "write the counts to stdout at the end");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_lossy(options); });
}

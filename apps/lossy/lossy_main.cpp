// dance lossy: a UDP proxy that emulates a bad line.

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/program/program.h"
#include "core/program/talk.h"
#include "testing/line/line_options.h"
#include "testing/line/lossy_proxy.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance lossy --link 'delay=80ms jitter=10ms loss=1%'   then: dance link --server 127.0.0.1:7401 …
  dance lossy --link 'loss=2% burst=4 dup=0.1% reorder=1% rate=1Mbit queue=50ms seed=7'
  dance lossy --link-up 'rate=2Mbit queue=1s' --link-down 'rate=20Mbit'
  dance lossy --trace starlink_a_rtt.csv.xz --json           counts at the end, on stdout
  dance lossy --trace-up lte.up.xz --trace-down lte.down.xz --link 'delay=30ms queue=500ms'
  dance lossy --trace wifi.csv.xz --offset 61                from the 61st second on
Words of a link, each way: delay and jitter (±) as times; loss, dup (comes twice) and reorder (is
overtaken) in per cent; burst, the mean number lost in a row; rate; queue, the longest that a
datagram waits for the rate or for a capacity trace before it is dropped; seed. A trace is measured
delays, or moments at which 1,500 bytes can leave; either is repeated at its end.
)";

struct LossyOptions {
  std::string listen = "127.0.0.1:7401";
  std::string to = "127.0.0.1:7400";
  LineWords line;
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
  DANCE_TRY(LossyLine line, load_line(options.line));
  DANCE_TRY(const Address listen, Address::resolve(options.listen));
  DANCE_TRY(const Address target, Address::resolve(options.to));
  DANCE_TRY(auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return stops;
  DANCE_TRY(auto proxy, LossyProxy::open(listen, target, std::move(line), *poller));
  std::string words = options.line.is_perfect_line() ? "no delay, no loss" : "";
  for (const std::string& word : line_arguments(options.line))
    words += (words.empty() ? "" : " ") + word;
  talk::info("{} to {} and back: {}", proxy->local_address().to_string(), target.to_string(),
             words);
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
  dance::add_link_options(line, options.line);
  dance::add_trace_options(line, options.line);
  line.add_flag("--json", options.json, "write the counts to stdout at the end");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_lossy(options); });
}

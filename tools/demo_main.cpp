// dance demo: two houses with a bus each, a server between them, dancers, a stage, all on this machine.

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "core/bus/multicast_route.h"
#include "core/net/private_network.h"
#include "core/program/program.h"
#include "tools/demo_run.h"
#include "tools/demo_summary.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance demo                                     two salsa dancers, in a window
  dance demo --link "delay=80ms jitter=10ms loss=1%"
                                                 the same, 80 ms apart, on a bad line
  dance demo --motion lead.bvh,follow.bvh        your own takes
  dance demo --headless --seconds 10 --out pics  pictures and numbers instead of a window
  dance demo --guests 30 --headless --json       a crowd, measured
)";

bool has_display() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"}) {
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): one thread
    if (value && *value) return true;
  }
  return false;
}

// The buses stay on this machine: over loopback where that carries multicast, else in a network of our own.
Result<void> choose_network(bool here) {
  const std::string device = multicast_device("239.255.76.67");
  if (here) {
    if (device.empty())
      return fail("--here: this machine has no route for multicast; add one with: " +
                  std::string(kMulticastCure));
    return {};
  }
  if (device == "lo") return {};
  if (auto entered = enter_private_network(); !entered) {
    if (!device.empty()) return {};  // rides on that device; ttl 0 keeps it here
    return fail(entered.error().what + "; or add a route for multicast with: " + kMulticastCure);
  }
  spdlog::info(
      "in a network of its own (to watch it: nsenter -t {} -n …; with a multicast route on lo, or "
      "--here, it "
      "uses this machine's)",
      getpid());
  return {};
}

Result<void> run_demo(DemoOptions options, bool here) {
  if (!options.headless && !has_display()) {
    spdlog::info("there is no display: writing pictures to {} instead (--headless)", options.out);
    options.headless = true;
  }
  if (options.headless && options.seconds <= 0.0) options.seconds = 10.0;
  if (auto network = choose_network(here); !network) return network;
  DANCE_TRY(DemoPlan plan, plan_demo(options));
  DANCE_TRY(auto run, DemoRun::prepare(options, std::move(plan)));
  DANCE_TRY(const DemoResult result, run->run());
  std::fputs((options.json ? summary_json(result) + "\n" : summary_table(result)).c_str(), stdout);
  if (options.headless && result.pictures.empty())
    return fail("no pictures were made; " + options.out + "/view.txt says why");
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::DemoOptions options;
  bool here = false;
  CLI::App app{
      "Two houses with a bus each, a server between them, dancers, a stage: the main job on one "
      "machine.",
      "dance demo"};
  app.add_option("--seconds", options.seconds,
                 "how long; 0 = until the window is closed (headless: 10)")
      ->check(CLI::Range(0.0, 86400.0));
  app.add_option("--guests", options.guests, "dancers, shared out to the two houses")
      ->check(CLI::Range(2, 32));
  app.add_option("--motion", options.motion,
                 "BVH files for the dancers in turn, with commas between")
      ->delimiter(',');
  app.add_option("--link", options.link,
                 "what the line between the houses does, e.g. \"delay=80ms jitter=10ms loss=1%\"");
  app.add_option("--trace", options.trace, "a recorded line (.csv, .csv.xz)");
  app.add_flag("--headless", options.headless, "no window: pictures and a summary");
  app.add_option("--out", options.out, "folder for pictures, log and what the programs said")
      ->capture_default_str();
  app.add_flag("--json", options.json, "the summary as JSON on stdout, and nothing else there");
  app.add_option("--through", options.through, "transformers for remote dancers")
      ->capture_default_str();
  app.add_option("--tempo", options.tempo_bpm, "beats a minute of the synthetic dancers")
      ->check(CLI::Range(60.0, 240.0))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "which synthetic dance")->check(CLI::Range(0, 1'000'000));
  app.add_option("--hz", options.hz, "poses a second")
      ->check(CLI::Range(1.0, 240.0))
      ->capture_default_str();
  app.add_option("--port", options.port, "UDP port of the server; 0 = one that is free")
      ->check(CLI::Range(0, 65535));
  app.add_flag("--here", here,
               "use this machine's network even where multicast does not run over loopback");
  app.footer(dance::kExamples);
  return dance::run_program(app, argc, argv, [&] { return dance::run_demo(options, here); });
}

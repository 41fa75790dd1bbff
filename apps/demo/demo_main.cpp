// dance demo: two houses with a bus each, a server between them, dancers, a stage, all on this
// machine.

#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "apps/demo/demo_run.h"
#include "apps/demo/demo_summary.h"
#include "core/bus/route/multicast_route.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "testing/line/line_options.h"
#include "testing/private_network.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance demo                                     two salsa dancers, in a window
  dance demo --link "delay=80ms jitter=10ms loss=1%"
                                                 the same, 80 ms apart, on a bad line
  dance demo --trace-up lte.up.xz --trace-down lte.down.xz
                                                 the same, over a recorded line
  dance demo --motion lead.bvh,follow.bvh        your own takes
  dance demo --headless --seconds 10 --out pics  pictures and numbers instead of a window
  dance demo --compare                           as poses come, and in rhythm, side by side
  dance demo --compare --music song.ogg          to your own song, its beats in song.beats
  dance demo --compare --headless --film --out pics
                                                 the same as pictures, a plot and a film
  dance demo --guests 30 --headless --json       a crowd, measured
)";

// Between continents, on Wi-Fi.
constexpr const char* kFarLine = "delay=120ms jitter=15ms loss=1%";

// Uses a network namespace of its own, so that the demo's dancers do not appear in a house here.
// It stays in this one if multicast is routed over lo, so that LCM's programs can watch.
void choose_network(bool here) {
  if (here || multicast_device("239.255.76.67") == "lo") return;
  if (!enter_private_network()) return;  // the bus stays on this machine all the same
  talk::info(
      "in a network of its own (to watch it: nsenter -t {} -n …; with a multicast route on lo, or "
      "--here, it "
      "uses this machine's)",
      getpid());
}

Result<void> run_demo(DemoOptions options, bool here) {
  if (!options.headless && display_name().empty()) {
    talk::info("there is no display: writing pictures to {} instead (--headless)", options.out);
    options.headless = true;
  }
  if (options.compare) {
    if (options.guests != 2) return fail("--compare is for two dancers: leave out --guests");
    if (options.line.is_perfect_line()) {
      options.line.link = kFarLine;
      talk::info("the houses are far apart: --link \"{}\"", kFarLine);
    }
  }
  if (options.film && !(options.compare && options.headless))
    return fail("--film is of a comparison in files: add --compare --headless");
  options.view = std::filesystem::exists(program_folder() + "/dance-view");
  if (!options.view) {
    if (options.film)
      return fail("--film wants the viewer, which was not built; ./dance setup builds it");
    talk::info("built without the viewer: numbers and a log, no pictures");
    options.headless = true;
  }
  if (options.headless && options.seconds <= 0.0) options.seconds = 10.0;
  choose_network(here);
  DANCE_TRY(DemoPlan plan, plan_demo(options));
  DANCE_TRY(auto run, DemoRun::prepare(options, std::move(plan)));
  DANCE_TRY(const DemoResult result, run->run());
  std::fputs((options.json ? summary_json(result) + "\n" : summary_table(result)).c_str(), stdout);
  if (options.view && options.headless && result.pictures.empty())
    return fail("no pictures were made; " + programs_folder(options) + "/view.txt says why");
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::DemoOptions options;
  bool here = false;
  dance::CommandLine line(
      "Two houses with a bus each, a server between them, dancers, a stage: the main job on one "
      "machine.",
      "dance demo");
  line.add("--seconds", options.seconds, "how long; 0 = until the window is closed (headless: 10)")
      .range(0.0, 86400.0);
  line.add("--guests", options.guests, "dancers, shared out to the two houses").range(2, 32);
  line.add("--motion", options.motion, "BVH files for the dancers in turn, with commas between")
      .split_at(',');
  dance::add_link_options(line, options.line);
  dance::add_trace_options(line, options.line);
  line.add_flag("--headless", options.headless, "no window: pictures and a summary");
  line.add("--out", options.out, "folder for pictures, log and the programs' messages")
      .shows_default();
  line.add_flag("--json", options.json, "the summary as JSON on stdout, and nothing else there");
  line.add(
      "--through", options.through,
      "a transformer for remote dancers instead of those of dance join; once more for the next");
  line.add("--music", options.music,
           "a song with its .beats beside it, or none; without it a percussion at --tempo");
  line.add("--tempo", options.tempo_bpm, "beats a minute, without a song")
      .range(60.0, 240.0)
      .shows_default();
  line.add("--seed", options.seed, "which synthetic dance").range(0, 1'000'000);
  line.add("--hz", options.hz, "poses a second").range(1.0, 240.0).shows_default();
  line.add_flag("--compare", options.compare,
                "two halves: as poses come, and as the stage shows them; measures both");
  line.add_flag("--film", options.film,
                "with --compare --headless: a film of it too, picture by picture");
  line.add("--port", options.port, "UDP port of the server; 0 = one that is free").range(0, 65535);
  line.add_flag("--here", here,
                "use this machine's network even where lo has no route for multicast");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_demo(options, here); });
}

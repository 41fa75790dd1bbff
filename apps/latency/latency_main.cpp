// dance-latency: the table of a pose's journey with numbers, per guest, from the stamps that each
// step leaves.

#include <cstdio>

#include "apps/bus_program.h"
#include "apps/latency/latency_report.h"
#include "core/net/mono_clock.h"
#include "core/program/program.h"

namespace dance {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  dance latency                        every guest on this house's stage, for 5 s\n"
    "  dance latency --guest bob --seconds 30\n"
    "  dance latency --json | jq '.guests[].steps'\n"
    "Steps are those of docs/latency.md. Each row: how long that step took, and how long all took "
    "up to there.\n";

struct Options {
  std::string bus_url;
  double seconds = 5.0;
  std::string guest;
  bool is_json = false;
};

Result<void> measure(const Options& options) {
  const GuestId guest = GuestId::parse(options.guest).value_or(GuestId());
  DANCE_TRY(BusProgram program, BusProgram::open(options.bus_url));
  Journeys journeys;
  program.bus().subscribe<Pose>({Where::kStage, guest},
                                [&](const Channel& channel, const Pose& pose, MonoTime now) {
                                  if (GuestJourney* journey = journeys.of(channel.guest()))
                                    journey->heard(pose, now, this_clock_id());
                                });
  program.bus().subscribe<StageTime>(Where::kView,
                                     [&](const Channel& channel, const StageTime& time, MonoTime) {
                                       if (guest.is_set() && !(channel.guest() == guest)) return;
                                       if (GuestJourney* journey = journeys.of(channel.guest()))
                                         journey->shown(time);
                                     });
  program.stop_after(options.seconds);
  const MonoTime begin = mono_now();
  program.run();
  const LatencyScope scope{program.bus().url(), (mono_now() - begin).as_seconds()};
  const std::string text =
      options.is_json ? latency_json(journeys, scope) : latency_table(journeys, scope);
  std::fputs(text.c_str(), stdout);
  if (!journeys.all().empty()) return {};
  return fail("no poses on the stage of " + scope.bus_url +
              "; is a house running there? `dance top` shows what is on it");
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Options options;
  dance::CommandLine line("The journey of each guest's poses, step by step, with numbers.",
                          "dance latency");
  line.add("--bus", options.bus_url, "LCM URL of the bus");
  line.add("--seconds", options.seconds, "how long to listen (0: ctrl-C)").range(0.0, 1e7);
  line.add("--guest", options.guest, "only this guest").guest_name();
  line.add_flag("--json", options.is_json, "one JSON object instead of the table");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::measure(options); });
}

// dance-style: says over the bus how large a guest's dance is to be shown.
#include <string_view>

#include "apps/bus_program.h"
#include "core/control/house_publisher.h"
#include "core/net/mono_clock.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "transformers/style/style_presets.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance style alice hips=1.5 arms=1.2          until ctrl-C, once a second
  dance style alice preset=cuban head=1 --seconds 5
  dance style alice preset=as-danced --once
Zones: hips, torso, shoulders, arms, hands, legs, head. Gains: 0 to 3, 1 as danced. mix=0 amplifies
only the motion that repeats with each bar; mix=1 (the default here) all motion. The link sends it
to the other houses; a stage shows it where its route says stylize, whose own gains are multiplied
with these. The last style published stays in force.
)";

constexpr Duration kLooksFor = Duration::s(3);

struct Options {
  std::string bus_url;
  std::string guest;
  std::vector<std::string> words;
  double seconds = 0.0;
  bool is_once = false;
};

Result<void> say(const Options& options) {
  const std::vector<std::string_view> words(options.words.begin(), options.words.end());
  DANCE_TRY(Style style, read_style("style", words, 1.0));
  style.clock_id = this_clock_id();
  const auto guest = GuestId::parse(options.guest);
  DANCE_TRY(BusProgram program, BusProgram::open(options.bus_url));
  const Channel channel = Channel::of(Signal::kStyle, Where::kCapture, *guest);
  HousePublisher port(program.bus(), program.bus().url(), program.poller());
  const auto publish = [&] {
    style.time = mono_now();
    port.publish(channel, style);
  };
  publish();
  if (options.is_once) return {};
  talk::info("says how {} is to be shown, once a second; Ctrl-C ends it", options.guest);
  program.every(Duration::s(1), [&](MonoTime) { publish(); });
  bool is_here = false;
  for (const Where where : {Where::kCapture, Where::kGuest})
    program.bus().subscribe<Pose>(
        {where, *guest}, [&](const Channel&, const Pose&, MonoTime) { is_here = true; },
        Delivery::kNewest);
  program.poller().add_timer(mono_now() + kLooksFor, [&](MonoTime) {
    if (!is_here)
      talk::warn("nobody called {} dances on {} yet; who does, dance top shows", options.guest,
                 program.bus().url());
    return MonoTime();
  });
  program.stop_after(options.seconds);
  program.run();
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Options options;
  dance::CommandLine line("Says how large a guest's dance is to be shown, zone by zone.",
                          "dance style");
  line.add("GUEST", options.guest, "whose dance").required().guest_name();
  line.add("SETTINGS", options.words, "hips=1.5 preset=cuban mix=0.5 ...").required();
  line.add("--bus", options.bus_url, "LCM URL of the bus");
  line.add("--seconds", options.seconds, "stop after so long (0: ctrl-C)").range(0.0, 1e7);
  line.add_flag("--once", options.is_once, "say it once and end");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::say(options); });
}

// dance haptics: what a dancer feels: touches, the beat, the lead's hand, on devices.

#include <sched.h>
#include <unistd.h>

#include <array>
#include <cstdio>

#include "core/bus/bus.h"
#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "core/program/foreground.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "haptics/evdev/evdev_devices.h"
#include "haptics/haptic_control.h"
#include "haptics/haptics_check.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance haptics list                                 what can be felt with on this machine
  dance haptics --guest alice --to evdev             the first gamepad rumbles for alice
  dance haptics --guest alice --to evdev --device Joy-Con --limit 0.6
  dance haptics --guest alice --to sound --device tactors --feel one lead
  dance haptics --guest alice --to osc --address 192.168.1.7:9001
  dance haptics --guest alice --to bhaptics          the bHaptics Player of this machine
  dance haptics --guest alice --to evdev --device 'Joy-Con (L)' --bones leftHand leftLowerArm
                                                     one for the left hand, one for the right
  dance haptics --guest alice --to evdev --from bob  what bob does, and nobody else
  dance haptics set --guest alice --off              from another terminal, while it runs
  dance haptics --check --to osc                     how exactly orders reach a device
In a terminal, enter switches everything off, and on again. Several --to at once are several
devices. --feel takes touch: bodies that touch and hands that hold; lead: what the partner's hand
does in a hold; one: the first beat of each bar; beats: all of them.
)";

struct HapticsWishes {
  std::string what, bus, guest, device, address;
  std::vector<std::string> to, from, bones;
  std::vector<std::string> feel{"touch", "lead", "one"};
  double strength = 1.0, limit = 1.0, latency_ms = 0.0, seconds = 0.0;
  bool check = false, realtime = false, off = false, quiet = false;
};

Result<HapticOptions> options_of(const HapticsWishes& wishes) {
  HapticOptions options;
  options.device = wishes.device;
  options.address = wishes.address;
  options.player.strength = static_cast<float>(wishes.strength);
  options.player.limit = static_cast<float>(wishes.limit);
  options.player.is_on = !wishes.off;
  options.player.latency = Duration::seconds(1e-3 * wishes.latency_ms);
  DANCE_TRY(options.player.bones, parse_bones(wishes.bones));
  DANCE_TRY(options.maker, parse_felt(wishes.feel));
  for (const std::string& name : wishes.from) options.maker.from.push_back(*GuestId::parse(name));
  return options;
}

Result<void> list_devices() {
  std::string text;
  for (const EvdevDevice& device : list_evdev_devices())
    text += "evdev     " + device.path + "  " + device.name + "  " +
            std::to_string(device.effects) + " effects" +
            (device.trouble.empty() ? "" : "; " + device.trouble) + "\n";
  HapticOptions options;
  if (auto sound = make_haptic_output("sound", options))
    text += "sound     the usual sink of the sound server\n";
  if (text.empty()) text = "no device is connected to this machine\n";
  text += "osc       any program or device that takes OSC: --address host:port\n";
  text += "bhaptics  a bHaptics Player: --address host:port, without it the one of this machine\n";
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

Result<void> run_check(const HapticsWishes& wishes, const HapticOptions& options, Poller& poller) {
  std::vector<HapticCheck> checks;
  const std::vector<std::string> kinds = wishes.to.empty() ? haptic_output_names() : wishes.to;
  std::string missing;
  for (const std::string& to : kinds) {
    const double seconds = wishes.seconds > 0.0 ? wishes.seconds : 4.0;
    auto check = check_haptics(to, options, poller, Duration::seconds(seconds));
    if (check)
      checks.push_back(*check);
    else if (!wishes.to.empty())
      return tl::make_unexpected(check.error());
    else
      missing += to + ": " + check.error().what + "\n";
  }
  const std::string text = haptic_check_table(checks) + missing;
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

// Enter on the terminal.
void watch_terminal(Poller& poller, HapticFeed& feed) {
  if (!is_in_foreground()) return;
  talk::info("enter switches off, and on again");
  poller.watch(STDIN_FILENO, [&poller, &feed](MonoTime) {
    std::array<char, 256> line{};
    if (read(STDIN_FILENO, line.data(), line.size()) <= 0) {
      poller.unwatch(STDIN_FILENO);
      return;
    }
    feed.set_on(!feed.is_on());
    talk::info("{}", feed.is_on() ? "on" : "off");
  });
}

// So that other programs' work does not delay what is felt: this one has next to none.
void ask_for_realtime() {
  sched_param priority{};
  priority.sched_priority = 5;
  if (sched_setscheduler(0, SCHED_FIFO, &priority) != 0)
    talk::warn(
        "no real-time priority here: run as root, or give this user rtprio in "
        "/etc/security/limits.conf");
}

Result<void> run(const HapticsWishes& wishes) {
  if (wishes.what == "list") return list_devices();
  if (wishes.realtime) ask_for_realtime();
  DANCE_TRY(const HapticOptions options, options_of(wishes));
  DANCE_TRY(const auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return tl::make_unexpected(stops.error());
  if (wishes.check) return run_check(wishes, options, *poller);
  const auto guest = GuestId::parse(wishes.guest);
  if (!guest) return fail("--guest says who feels it, as --guest alice");
  DANCE_TRY(const auto bus, Bus::open(wishes.bus));
  HapticFeed feed(*guest, options.maker, *bus, *poller);
  for (const std::string& to : wishes.to) {
    HapticOptions own = options;
    // Of several kinds each takes what is for it.
    if (wishes.to.size() > 1 && !check_haptic_options(to, own)) {
      own.device.clear();
      if (!check_haptic_options(to, own)) own.address.clear();
    }
    DANCE_TRY(auto output, make_haptic_output(to, own));
    feed.add(std::make_unique<HapticPlayer>(std::move(output), own.player, *poller));
  }
  for (const auto& player : feed.players())
    player->tell_changes([](bool is_there, const std::string& line) {
      is_there ? talk::info("{}", line) : talk::warn("{}", line);
    });
  const auto control = HapticControl::open(
      wishes.bus, {&feed}, [](const std::string& line) { talk::info("{}", line); }, *poller);
  if (!control) talk::warn("{}", control.error().what);
  poller->watch(bus->fd(), [&](MonoTime now) { bus->drain(now); });
  if (!wishes.quiet) watch_terminal(*poller, feed);
  if (wishes.seconds > 0.0) {
    poller->add_timer(mono_now() + Duration::seconds(wishes.seconds), [&](MonoTime) {
      poller->stop();
      return MonoTime();
    });
  }
  talk::info("{} feels TOUCH/stage/{} on {}", guest->view(), guest->view(), bus->url());
  poller->run();
  poller->unwatch(bus->fd());
  talk::info("{} touches heard, {} haptics made, {} heard of others", feed.touches(), feed.made(),
             feed.heard());
  if (feed.left_out() > 0)
    talk::info("{} touches were left out, as others touched more often than is felt",
               feed.left_out());
  if (feed.of_other_clocks() > 0)
    talk::warn("{} messages are of another machine's clock and were left out",
               feed.of_other_clocks());
  for (const auto& player : feed.players()) talk::info("{}", player->summary());
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::HapticsWishes wishes;
  dance::CommandLine line("What a dancer feels: touches, the beat, the lead's hand, on devices.",
                          "dance haptics");
  line.add("WHAT", wishes.what, "list: the devices of this machine").one_of({"list"});
  line.add("--guest", wishes.guest, "who feels it").guest_name();
  line.add("--to", wishes.to, "kinds of devices").one_of(dance::haptic_output_names());
  line.add("--feel", wishes.feel, "touch, lead, one, beats; without it touch, lead and one");
  line.add("--from", wishes.from, "whose touches are felt; without it everybody's").guest_name();
  line.add("--bones", wishes.bones, "of what is felt, that of these bones only, as leftHand");
  line.add("--device", wishes.device,
           "evdev: a path, or a part of the name; sound: the sink. Without it, the first");
  line.add("--address", wishes.address, "osc and bhaptics: host:port; without it, the usual one");
  line.add("--strength", wishes.strength, "times the amplitude").range(0.0, 2.0).shows_default();
  line.add("--limit", wishes.limit, "nothing is felt more strongly, 1 = all the device has")
      .range(0.0, 1.0)
      .shows_default();
  line.add("--latency", wishes.latency_ms,
           "ms that the device is late, beside what it reports itself")
      .range(0.0, 400.0)
      .shows_default();
  line.add("--seconds", wishes.seconds, "how long; 0 = until told to stop").range(0.0, 1e7);
  line.add("--bus", wishes.bus, "LCM URL of the bus");
  line.add_flag("--realtime", wishes.realtime, "goes before other programs, where it may");
  line.add_flag("--off", wishes.off, "felt only once it is switched on");
  line.add_flag("--quiet", wishes.quiet, "enter in this terminal switches nothing");
  line.add_flag("--check", wishes.check, "measures how exactly orders reach the devices");
  line.footer(dance::kExamples);
  line.finally([&]() -> dance::Result<void> {
    if (auto felt = dance::parse_felt(wishes.feel); !felt) return tl::make_unexpected(felt.error());
    if (auto bones = dance::parse_bones(wishes.bones); !bones)
      return dance::fail("--bones: " + bones.error().what);
    if (wishes.what.empty() && !wishes.check && (wishes.guest.empty() || wishes.to.empty()))
      return dance::fail("say who feels it and with what: --guest alice --to evdev; or: list");
    return {};
  });
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}

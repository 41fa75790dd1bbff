#include "apps/avatar/avatar_choose.h"

#include <set>

#include "apps/bus_program.h"
#include "core/control/house_publisher.h"
#include "core/net/mono_clock.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "house/avatar_choice.h"

namespace dance {
namespace {

constexpr const char* kChooseExamples = R"(Examples:
  dance avatar choose alice me.vrm                   from now on, for everybody in the room
  dance avatar choose alice mannequin --look dress-bun --colour '#e04080'
  dance avatar choose alice mannequin                as her name makes it
  dance avatar choose alice me.vrm --stay            said again each second, until Ctrl-C
A house of dance join keeps the choice until it ends; to keep it longer, write [[avatar]] into the
session file. Where link and manager run by themselves, --stay tells displays that start later.
)";

// A choice is repeated until a house repeats it of its own accord, as each does once a second: it
// may only just be starting, and multicast may lose a message.
constexpr Duration kBetween = Duration::ms(40);
constexpr Duration kGiveUpAfter = Duration::s(4);
constexpr std::size_t kTimesKept = 256;

struct ChooseOptions {
  std::string bus_url;
  std::string guest;
  AvatarChoice choice;
  bool stays = false;
};

Result<void> choose_for_guest(const ChooseOptions& options) {
  const auto guest = GuestId::parse(options.guest);
  const AvatarStore store = AvatarStore::of_user();
  DANCE_TRY(ChosenAvatar chosen, choose_avatar(options.choice, store, data_folder() + "/avatars"));
  for (const std::string& note : chosen.notes) talk::info("{}: {}", options.choice.what, note);
  DANCE_TRY(BusProgram program, BusProgram::open(options.bus_url));
  chosen.avatar.clock_id = chosen.file.clock_id = this_clock_id();
  HousePublisher port(program.bus(), program.bus().url(), program.poller());
  std::set<std::int64_t> times_said;  // µs, as on the bus
  const auto publish = [&] {
    chosen.avatar.time = chosen.file.time = mono_now();
    times_said.insert(chosen.avatar.time.since_zero_us());
    if (times_said.size() > kTimesKept) times_said.erase(times_said.begin());
    port.publish(Channel::of(Signal::kAvatar, Where::kCapture, *guest), chosen.avatar);
    port.publish(Channel::of(Signal::kAvatarFile, Where::kCapture, *guest), chosen.file);
  };
  bool keeps_avatar = false;
  bool is_kept = false;
  const auto kept = [&] {
    is_kept = true;
    if (!options.stays) program.poller().stop();
  };
  program.bus().subscribe<Avatar>(
      {Where::kCapture, *guest}, [&](const Channel&, const Avatar& heard, MonoTime) {
        keeps_avatar = !times_said.contains(heard.time.since_zero_us()) &&
                       heard.name == chosen.avatar.name &&
                       heard.colour_rgb == chosen.avatar.colour_rgb &&
                       heard.height_scale == chosen.avatar.height_scale;
      });
  program.bus().subscribe<AvatarFile>(
      {Where::kCapture, *guest}, [&](const Channel&, const AvatarFile& heard, MonoTime) {
        if (keeps_avatar && !times_said.contains(heard.time.since_zero_us()) &&
            heard.hash == chosen.file.hash)
          kept();
      });
  publish();
  if (chosen.file.hash.is_set())
    talk::info("{} is {}, {:.1f} MB, {}", options.guest, chosen.file.name.view(),
               chosen.file.size_bytes / 1e6, hex_of(chosen.file.hash).substr(0, 12));
  else
    talk::info("{} is {}", options.guest, chosen.avatar.name.view());
  program.every(options.stays ? Duration::s(1) : kBetween, [&](MonoTime) { publish(); });
  if (!options.stays) program.stop_after(kGiveUpAfter.as_seconds());
  program.run();
  if (!is_kept && !options.stays)
    talk::warn(
        "no house keeps this choice: only displays that run now show it; dance join keeps it, or "
        "--stay says it again each second");
  return {};
}

}  // namespace

int avatar_choose_main(int argc, char** argv) {
  ChooseOptions options;
  CommandLine line("Says how a guest of this house is drawn, here and at the others'.",
                   "dance avatar choose");
  line.add("GUEST", options.guest, "whose avatar").required().guest_name();
  line.add(
          "AVATAR", options.choice.what,
          "a file (.vrm or .glb, at most 16 MB), a name that dance avatar list shows, or mannequin")
      .required();
  line.add(
      "--look", options.choice.look,
      "of the mannequin: words joined by '-', as flared-tail-long; dance avatar list shows them");
  line.add("--colour", options.choice.colour, "of the mannequin's top, as '#e04080'");
  line.add("--height", options.choice.height, "how tall, times the dancer's own height")
      .range(0.25, 4.0)
      .shows_default();
  line.add("--bus", options.bus_url, "LCM URL of the house's bus");
  line.add_flag("--stay", options.stays, "say it again each second, until Ctrl-C");
  line.footer(kChooseExamples);
  return run_program(line, argc, argv, [&] { return choose_for_guest(options); });
}

}  // namespace dance

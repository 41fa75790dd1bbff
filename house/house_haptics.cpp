#include "house/house_haptics.h"

#include <unistd.h>

#include "core/bus/bus.h"
#include "core/net/local_address.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "haptics/haptic_control.h"
#include "house/session_haptics.h"

namespace dance {
namespace {

// The house listens beside its programs, whose numbers are their process ids: the upper half is its
// own.
std::uint64_t control_number(std::size_t number) {
  return (std::uint64_t{number} + 1) << 32 | static_cast<std::uint64_t>(getpid());
}

}  // namespace

HouseHaptics::HouseHaptics(const HostedHaptics& haptics, const std::string& bus, std::size_t number,
                           Poller& poller)
    : haptics_(haptics), path_(control_path("haptics", bus_url_or_default(bus), haptics.guest)) {
  listen(number, poller);
  program_ = std::make_unique<HostedProgram>(program_options(bus), poller);
}

HostedProgram::Options HouseHaptics::program_options(const std::string& bus) {
  HostedProgram::Options options;
  options.path = program_folder() + "/dance-haptics";
  options.name = "dance haptics of " + std::string(haptics_.guest.view());
  options.without = "without it";
  options.arguments = [this, bus] {
    was_told_ = false;
    return haptics_arguments(haptics_, bus);
  };
  options.works = [this](pid_t running, MonoTime) { return works(running); };
  return options;
}

void HouseHaptics::listen(std::size_t number, Poller& poller) {
  auto opened = ProgramControl::open(
      numbered_control_path(path_, control_number(number)),
      [this](std::string_view command, MonoTime) { hear(command); }, poller);
  if (opened)
    control_ = std::move(*opened);
  else
    talk::warn("{}; where dance haptics of {} is started again, it is as the session file has it",
               opened.error().what, haptics_.guest.view());
}

// What is no command the program counts.
void HouseHaptics::hear(std::string_view text) {
  const auto command = parse_haptic_command(text);
  if (!command) return;
  if (command->kind == HapticCommand::Kind::kLimit)
    haptics_.options.player.limit = command->limit;
  else
    haptics_.options.player.is_on = command->kind == HapticCommand::Kind::kOn;
  was_told_ = true;
}

// It listens once it has its devices; what was said between its start and then reached the house
// only.
bool HouseHaptics::works(pid_t program) {
  const std::string path = numbered_control_path(path_, static_cast<std::uint64_t>(program));
  if (!is_socket(path)) return false;
  if (!was_told_) return true;
  using Kind = HapticCommand::Kind;
  const HapticPlayerOptions& player = haptics_.options.player;
  for (const HapticCommand& command : {HapticCommand{Kind::kLimit, player.limit},
                                       HapticCommand{player.is_on ? Kind::kOn : Kind::kOff, 1.0f}})
    if (auto told = send_to_program(path, text_of(command)); !told || *told != Told::kSent)
      return false;
  return true;
}

}  // namespace dance

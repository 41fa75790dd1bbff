#include "voice/program/voice_control.h"

#include "core/bus/bus.h"

namespace dance {

std::string voice_control_path(const std::string& bus, const GuestId& guest) {
  return control_path("voice", bus_url_or_default(bus), guest);
}

Result<std::unique_ptr<VoiceControl>> VoiceControl::open(const std::string& bus,
                                                         const GuestId& guest, OnCommand on_command,
                                                         Poller& poller) {
  auto control =
      ProgramControl::open(voice_control_path(bus, guest), std::move(on_command), poller);
  if (!control)
    return fail("the voice of " + std::string(guest.view()) + " cannot be told anything: " +
                control.error().what + "; a guest has one dance voice on a bus");
  return std::unique_ptr<VoiceControl>(new VoiceControl(std::move(*control)));
}

Result<void> tell_voice(const std::string& bus, const GuestId& guest, std::string_view command) {
  DANCE_TRY(const Told told, tell_program(voice_control_path(bus, guest), command));
  if (told == Told::kNobody)
    return fail("no dance voice runs for " + std::string(guest.view()) +
                " on this bus; start it with: dance voice --guest " + std::string(guest.view()));
  if (told == Told::kFull)
    return fail("the dance voice of " + std::string(guest.view()) + " does not listen");
  return {};
}

}  // namespace dance

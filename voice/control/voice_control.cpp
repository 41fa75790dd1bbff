#include "voice/control/voice_control.h"

#include "core/bus/bus.h"
#include "core/net/local_address.h"

namespace dance {

std::string voice_control_path(const std::string& bus, const GuestId& guest) {
  return control_path("voice", bus_url_or_default(bus), guest);
}

Result<std::unique_ptr<VoiceControl>> VoiceControl::open(const std::string& bus,
                                                         const GuestId& guest, OnCommand on_command,
                                                         Poller& poller) {
  const std::string path = voice_control_path(bus, guest);
  auto control = ProgramControl::open(path, std::move(on_command), poller);
  const std::string name(guest.view());
  if (!control && is_socket(path))
    return fail(name + " has a dance voice on this bus already, perhaps of its house's [voice]: " +
                "end that one first, or tell it things with: dance voice set --guest " + name);
  if (!control)
    return fail("the voice of " + name + " cannot be told anything: " + control.error().what);
  return std::unique_ptr<VoiceControl>(new VoiceControl(std::move(*control)));
}

Result<void> send_voice_command(const std::string& bus, const GuestId& guest,
                                std::string_view command) {
  DANCE_TRY(const Told told, send_to_program(voice_control_path(bus, guest), command));
  if (told == Told::kNobody)
    return fail("no dance voice runs for " + std::string(guest.view()) +
                " on this bus; start it with: dance voice --guest " + std::string(guest.view()));
  if (told == Told::kFull)
    return fail("the dance voice of " + std::string(guest.view()) + " does not listen");
  return {};
}

}  // namespace dance

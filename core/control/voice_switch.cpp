#include "core/control/voice_switch.h"

#include "core/bus/bus.h"

namespace dance {
namespace {

constexpr std::string_view kVoiceOn = "on", kVoiceOff = "off";

std::string switch_path(const std::string& bus, const GuestId& guest) {
  return control_path("voice-switch", bus_url_or_default(bus), guest);
}

}  // namespace

Result<std::unique_ptr<ProgramControl>> open_voice_switch(const std::string& bus,
                                                          const GuestId& guest,
                                                          std::function<void(bool)> on_switch,
                                                          Poller& poller) {
  return ProgramControl::open(
      switch_path(bus, guest),
      [on_switch = std::move(on_switch)](std::string_view line, MonoTime) {
        if (line == kVoiceOn || line == kVoiceOff) on_switch(line == kVoiceOn);
      },
      poller);
}

bool has_voice_switch(const std::string& bus, const GuestId& guest) {
  return LocalDatagramSocket::is_served(switch_path(bus, guest));
}

Result<void> send_voice_switch(const std::string& bus, const GuestId& guest, bool is_on) {
  DANCE_TRY(const Told told,
            send_to_program(switch_path(bus, guest), is_on ? kVoiceOn : kVoiceOff));
  const std::string name(guest.view());
  if (told == Told::kFull) return fail("the house of " + name + " is unresponsive; end it");
  if (told != Told::kSent) return fail("no house here has a voice of " + name);
  return {};
}

}  // namespace dance

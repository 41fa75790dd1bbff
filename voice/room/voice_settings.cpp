#include "voice/room/voice_settings.h"

#include <string>

namespace dance {
namespace {

constexpr std::string_view kVolumeWord = "volume ";

}  // namespace

float VoiceSettings::volume_of(const GuestId& guest) const {
  for (const GuestVolume& volume : volumes_)
    if (volume.guest == guest) return volume.volume;
  return 1.0f;
}

Result<void> VoiceSettings::set_volume(std::string_view text) {
  const auto wanted = parse_guest_volume(text);
  if (!wanted) return fail(kGuestVolumeRule);
  for (GuestVolume& known : volumes_) {
    if (known.guest != wanted->guest) continue;
    known.volume = wanted->volume;
    return {};
  }
  if (!volumes_.try_push(*wanted))
    return fail("volumes of more than " + std::to_string(kMostVolumes) + " guests are not kept");
  return {};
}

HearingWish VoiceSettings::hearing() const {
  HearingWish wish;
  if (is_deafened) {
    wish.hears_others = false;
    return wish;
  }
  std::size_t count = 0;
  for (const GuestVolume& volume : volumes_)
    if (volume.volume <= 0.0f && count < wish.guests.size()) wish.guests[count++] = volume.guest;
  return wish;
}

Result<void> VoiceSettings::apply(std::string_view command, MonoTime now) {
  if (command.starts_with(kVolumeWord)) return set_volume(command.substr(kVolumeWord.size()));
  if (command == "mute" || command == "unmute")
    is_muted = command == "mute";
  else if (command == "deafen" || command == "undeafen")
    is_deafened = command == "deafen";
  else if (command == "push-to-talk" || command == "open")
    is_push_to_talk = command == "push-to-talk";
  else if (command == "with-picture" || command == "at-once")
    follows_picture = command == "with-picture";
  else if (command == "talk")
    talks_until = now + kTalkHolds;
  else if (command == "stop-talking")
    talks_until = now;
  else
    return fail("there is no such command; `dance voice set --help` lists them");
  return {};
}

}  // namespace dance

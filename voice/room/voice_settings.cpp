#include "voice/room/voice_settings.h"

#include <charconv>
#include <string>

namespace dance {
namespace {

constexpr std::string_view kVolumeWord = "volume ";

}  // namespace

float VoiceSettings::volume_of(const GuestId& guest) const {
  for (const Volume& volume : volumes_)
    if (volume.guest == guest) return volume.volume;
  return 1.0f;
}

Result<void> VoiceSettings::set_volume(std::string_view text) {
  const std::size_t equals = text.find('=');
  const auto guest = GuestId::parse(text.substr(0, equals));
  double volume = -1.0;
  if (equals != std::string_view::npos)
    std::from_chars(text.data() + equals + 1, text.data() + text.size(), volume);
  if (!guest || !(volume >= 0.0 && volume <= kLoudest))
    return fail("a volume is GUEST=0 to GUEST=2, as bob=0.5");
  for (Volume& known : volumes_) {
    if (known.guest != *guest) continue;
    known.volume = static_cast<float>(volume);
    return {};
  }
  if (!volumes_.try_push({*guest, static_cast<float>(volume)}))
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
  for (const Volume& volume : volumes_)
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
  else
    return fail("there is no such command; `dance voice set --help` lists them");
  return {};
}

}  // namespace dance

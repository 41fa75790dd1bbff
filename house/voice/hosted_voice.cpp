#include "house/voice/hosted_voice.h"

#include "core/bus/guest_volume.h"
#include "house/toml_reader.h"

namespace dance {

HostedVoice read_voice(TomlReader& reader, const GuestId& first) {
  HostedVoice voice;
  const auto guest = reader.maybe_string("guest");
  voice.guest = guest ? read_guest(reader, "guest", *guest) : first;
  voice.names_guest = guest.has_value();
  voice.microphone = reader.string_or("microphone", "");
  voice.loudspeaker = reader.string_or("loudspeaker", "");
  voice.reference = reader.string_or("reference", "");
  voice.enabled = reader.bool_or("enabled", true);
  voice.headphones = reader.bool_or("headphones", false);
  voice.push_to_talk = reader.bool_or("push_to_talk", false);
  voice.muted = reader.bool_or("muted", false);
  voice.deafened = reader.bool_or("deafened", false);
  voice.with_picture = reader.bool_or("with_picture", false);
  voice.low_delay = reader.bool_or("low_delay", false);
  voice.no_cleaning = reader.bool_or("no_cleaning", false);
  voice.buffer_ms = reader.number_or("buffer_ms", 0.0, 5.0, 200.0);
  voice.bitrate_kbit = reader.number_or("bitrate_kbit", 0.0, 6.0, 96.0);
  voice.volumes = reader.strings("volumes", "[\"bob=0.5\"]");
  for (const std::string& volume : voice.volumes)
    if (!parse_guest_volume(volume)) reader.complain("volumes", kGuestVolumeRule);
  reader.finish();
  if (!guest && !first.is_set())
    reader.complain("guest", "is missing: who speaks? this house has no dancer");
  return voice;
}

std::vector<std::string> voice_arguments(const HostedVoice& voice, const std::string& bus) {
  std::vector<std::string> words{"--bus", bus, "--guest", std::string(voice.guest.view()),
                                 "--quiet"};
  const auto add = [&](const char* option, const std::string& value) {
    words.push_back(std::string(option) + "=" + value);  // a value may begin with a dash
  };
  if (!voice.microphone.empty()) add("--microphone", voice.microphone);
  if (!voice.loudspeaker.empty()) add("--loudspeaker", voice.loudspeaker);
  if (!voice.reference.empty()) add("--reference", voice.reference);
  if (voice.headphones) words.emplace_back("--to-headphones");
  if (voice.push_to_talk) words.emplace_back("--push-to-talk");
  if (voice.muted) words.emplace_back("--mute");
  if (voice.deafened) words.emplace_back("--deafen");
  if (voice.with_picture) words.emplace_back("--with-picture");
  if (voice.low_delay) words.emplace_back("--low-delay");
  if (voice.no_cleaning) words.emplace_back("--no-cleaning");
  if (voice.buffer_ms > 0.0) add("--buffer", std::to_string(voice.buffer_ms));
  if (voice.bitrate_kbit > 0.0) add("--bitrate", std::to_string(voice.bitrate_kbit));
  for (const std::string& volume : voice.volumes) add("--volume", volume);
  return words;
}

}  // namespace dance

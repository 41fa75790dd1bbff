#include "lobby/checks/sound_advice.h"

#include <optional>
#include <string>

#include "lobby/checks/sound_check.h"

namespace dance {
namespace {

std::optional<Text> text_of_microphone(DeviceState state) {
  switch (state) {
    case DeviceState::kNone:
      return Text::kSoundMicrophoneNone;
    case DeviceState::kGone:
      return Text::kSoundMicrophoneGone;
    case DeviceState::kMuted:
      return Text::kSoundMicrophoneMuted;
    default:
      return std::nullopt;
  }
}

std::optional<Text> text_of_loudspeaker(DeviceState state) {
  switch (state) {
    case DeviceState::kNone:
      return Text::kSoundLoudspeakerNowhere;
    case DeviceState::kGone:
      return Text::kSoundLoudspeakerGone;
    case DeviceState::kMuted:
      return Text::kSoundLoudspeakerMuted;
    default:
      return std::nullopt;
  }
}

}  // namespace

SoundAdvice advise(const SoundState& state, const SoundLevel& level, bool echo_is_heard) {
  SoundAdvice advice;
  advice.count = 0;
  const auto say = [&](std::optional<Text> text) {
    if (text && advice.count < advice.texts.size()) advice.texts[advice.count++] = *text;
  };
  if (state.server == SoundState::Server::kNotBuilt) say(Text::kSoundNotBuilt);
  if (state.server == SoundState::Server::kNone) say(Text::kSoundNoServer);
  if (state.server == SoundState::Server::kConnecting) say(Text::kSoundOpening);
  if (state.server != SoundState::Server::kHere) return advice;
  say(text_of_microphone(state.microphone));
  const bool works = state.microphone == DeviceState::kWorks;
  if (works && level.is_silent) say(Text::kSoundSilent);
  if (works && level.clips) say(Text::kSoundClips);
  say(text_of_loudspeaker(state.loudspeaker));
  if (echo_is_heard) say(Text::kSoundEchoHeard);
  if (advice.count > 0) return advice;
  say(works && level.is_heard ? Text::kSoundGood
      : works                 ? Text::kSoundSaySomething
                              : Text::kSoundOpening);
  return advice;
}

std::string say_round_trip(const Texts& texts, const RoundTrip& trip) {
  if (!trip.is_heard) return texts[Text::kSoundNoEcho];
  return texts.say(Text::kSoundRoundTrip, {std::to_string(trip.delay.count_ms())});
}

}  // namespace dance

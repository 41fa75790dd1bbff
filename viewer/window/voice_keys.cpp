#include "viewer/window/voice_keys.h"

#include <algorithm>
#include <utility>

namespace dance {

const SceneVoice* VoiceKeys::find(const SceneState& scene,
                                  const std::optional<GuestId>& chosen) const {
  if (scene.voices.empty()) return nullptr;
  const auto found = std::find_if(scene.voices.begin(), scene.voices.end(),
                                  [&](const SceneVoice& voice) { return voice.guest == chosen; });
  return found == scene.voices.end() ? &scene.voices.front() : &*found;
}

void VoiceKeys::say(std::string words, MonoTime now) {
  words_ = std::move(words);
  said_ = now;
}

const std::string& VoiceKeys::words(MonoTime now) {
  if (!words_.empty() && now - said_ > kWordsHold) words_.clear();
  return words_;
}

void VoiceKeys::tell(const GuestId& guest, std::string_view command, MonoTime now) {
  if (const auto told = tell_(guest, command); !told) say(told.error().what, now);
}

void VoiceKeys::work(const SceneState& scene, const std::optional<GuestId>& chosen,
                     VoiceWishes& wishes, MonoTime now) {
  const bool mutes = std::exchange(wishes.mute_presses, 0) % 2 == 1;
  const bool deafens = std::exchange(wishes.deafen_presses, 0) % 2 == 1;
  // To the one who was told to talk, whoever is chosen meanwhile.
  if (!wishes.is_talk_held && talks_.is_set()) tell(std::exchange(talks_, {}), "stop-talking", now);
  if (!mutes && !deafens && !wishes.is_talk_held) return;
  const SceneVoice* voice = find(scene, chosen);
  if (voice == nullptr) return say(texts_[Text::kDanceNoVoice], now);
  if (voice->has_no_sound()) return say(texts_[Text::kBannerNoSound], now);
  if (mutes) tell(voice->guest, voice->is_muted ? "unmute" : "mute", now);
  if (deafens) tell(voice->guest, voice->is_deafened ? "undeafen" : "deafen", now);
  if (!wishes.is_talk_held) return;
  if (!voice->is_push_to_talk) say(texts_[Text::kVoiceKeyNotNeeded], now);
  if (voice->is_muted) say(texts_[Text::kVoiceMuted], now);
  if (voice->is_deafened) say(texts_[Text::kVoiceDeafened], now);
  if (!talks_.is_set()) talks_ = voice->guest, told_ = MonoTime();
  if (told_.is_set() && now - told_ < kTellsAgain) return;
  told_ = now;
  tell(talks_, "talk", now);
}

}  // namespace dance

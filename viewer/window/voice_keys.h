// VoiceKeys: what the keys of the voice tell the dance voice of a guest of this house: talk while
// held, mute, deafen. Of several guests with a voice the chosen one is told, else the first by
// name.
//
// Units/frames: MonoTime of this process.
// Ownership:    borrows what tells the voice.
// Threads:      none inside; the drawing thread owns it. Telling does not wait.
// Failure:      words() reports for a few seconds that no dance voice runs here or has no sound, or
//               why a command could not be sent.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "viewer/scene/scene.h"
#include "viewer/window/window_state.h"
#include "viewer/words/texts.h"

namespace dance {

class VoiceKeys {
 public:
  using Tell = std::function<Result<void>(const GuestId& guest, std::string_view command)>;
  // A dance voice takes a key for let go 0.7 s after the last time it was told.
  static constexpr Duration kTellsAgain = Duration::ms(200);
  static constexpr Duration kWordsHold = Duration::s(5);

  VoiceKeys(Tell tell, Language language) : tell_(std::move(tell)), texts_(language) {}

  // Once for each picture: obeys the wishes.
  void work(const SceneState& scene, const std::optional<GuestId>& chosen, VoiceWishes& wishes,
            MonoTime now);
  // What a person should know; "" mostly.
  const std::string& words(MonoTime now);

 private:
  const SceneVoice* find(const SceneState& scene, const std::optional<GuestId>& chosen) const;
  void tell(const GuestId& guest, std::string_view command, MonoTime now);
  void say(std::string words, MonoTime now);

  Tell tell_;
  Texts texts_;
  GuestId talks_;  // whose key is held; not set: none
  MonoTime told_;
  std::string words_;
  MonoTime said_;
};

}  // namespace dance

// VoiceBoard: how this house's guests speak at present, as their dance voices say, from the bus
// thread to the drawing thread.
//
// Units/frames: MonoTime of this process.
// Ownership:    kMostVoices states; never allocates after construction.
// Threads:      on_state() on the bus thread; take() on the drawing thread.
// Failure:      of more guests the one silent the longest makes room.
#pragma once

#include <algorithm>

#include "core/base/fixed_list.h"
#include "core/base/guest_id.h"
#include "core/base/latest.h"
#include "core/bus/voice.h"

namespace dance {

struct SaidVoice {
  GuestId guest;
  VoiceState state;
  MonoTime heard;
};

class VoiceBoard {
 public:
  static constexpr std::size_t kMostVoices = 16;
  // It is said once a second.
  static constexpr Duration kHolds = Duration::s(3);
  using Voices = FixedList<SaidVoice, kMostVoices>;

  void on_state(const GuestId& guest, const VoiceState& state, MonoTime now) {
    const SaidVoice said{guest, state, now};
    auto* known = std::find_if(voices_.begin(), voices_.end(),
                               [&](const SaidVoice& voice) { return voice.guest == guest; });
    if (known == voices_.end() && !voices_.try_push(said))
      known = std::min_element(
          voices_.begin(), voices_.end(),
          [](const SaidVoice& a, const SaidVoice& b) { return a.heard < b.heard; });
    if (known != voices_.end()) *known = said;
    latest_.put(voices_);
  }
  // If anything is new since the last call, else nullptr. Valid until the next call.
  const Voices* take() { return latest_.take(); }

 private:
  Voices voices_;  // of the bus thread
  Latest<Voices> latest_;
};

}  // namespace dance

// What a dancer sets of voices while they run: muted, deafened, how loud each guest is, and when
// voices are played. Other programs of the user change it with one line of text.
//
// Units/frames: volumes 0 to 2, 1 as it comes.
// Ownership:    plain value; volumes of kMostVolumes guests.
// Threads:      none inside.
// Failure:      apply() names the word that it does not know.
#pragma once

#include <string_view>

#include "core/base/fixed_list.h"
#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "core/base/time.h"
#include "core/bus/guest_volume.h"
#include "core/bus/voice.h"

namespace dance {

struct VoiceSettings {
  static constexpr std::size_t kMostVolumes = 64;
  // A key that is held repeats; so long after the last repetition it was let go.
  static constexpr Duration kTalkHolds = Duration::ms(700);

  bool is_muted = false;
  bool is_deafened = false;
  bool is_push_to_talk = false;
  bool follows_picture = false;
  MonoTime talks_until;

  bool sends(MonoTime now) const {
    return !is_muted && !is_deafened && (!is_push_to_talk || now < talks_until);
  }
  float volume_of(const GuestId& guest) const;
  Result<void> set_volume(std::string_view guest_and_volume);  // "bob=0.5"
  // Whose voices are to be sent here: not of those at volume 0, and nobody's while deafened.
  HearingWish hearing() const;

  // "mute", "unmute", "deafen", "undeafen", "talk", "stop-talking", "push-to-talk", "open",
  // "with-picture", "at-once", "volume bob=0.5".
  Result<void> apply(std::string_view command, MonoTime now);

 private:
  FixedList<GuestVolume, kMostVolumes> volumes_;
};

}  // namespace dance

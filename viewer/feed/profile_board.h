// ProfileBoard: passes the profiles of the room's guests (shown name, recording, host) from the bus
// thread to the drawing thread. A name holds until another arrives; the signs hold while the
// guest's link repeats them.
//
// Units/frames: MonoTime of this process.
// Ownership:    kMost profiles; never allocates after construction.
// Threads:      on_profile() on the bus thread; take() on the drawing thread.
// Failure:      when the board is full, the profile that was received longest ago is replaced.
#pragma once

#include <algorithm>

#include "core/base/fixed_list.h"
#include "core/base/guest_id.h"
#include "core/base/latest.h"
#include "core/bus/state_messages.h"

namespace dance {

struct SeenProfile {
  GuestId guest;
  bool is_remote = false;
  ShownName name;
  bool is_recording = false;
  bool is_host = false;
  MonoTime received;
};

class ProfileBoard {
 public:
  static constexpr std::size_t kMost = 128;
  // Links publish profiles once a second.
  static constexpr Duration kSignsHold = Duration::s(3);
  using Profiles = FixedList<SeenProfile, kMost>;

  void on_profile(const GuestId& guest, bool is_remote, const Profile& profile, MonoTime now) {
    const SeenProfile seen{guest,           is_remote, profile.shown_name, profile.is_recording,
                           profile.is_host, now};
    auto* known = std::find_if(profiles_.begin(), profiles_.end(),
                               [&](const SeenProfile& other) { return other.guest == guest; });
    if (known == profiles_.end() && !profiles_.try_push(seen))
      known = std::min_element(
          profiles_.begin(), profiles_.end(),
          [](const SeenProfile& a, const SeenProfile& b) { return a.received < b.received; });
    if (known != profiles_.end()) *known = seen;
    latest_.put(profiles_);
  }
  // The profiles if one was received since the last call, else nullptr. Valid until the next call.
  const Profiles* take() { return latest_.take(); }

 private:
  Profiles profiles_;  // used by the bus thread only
  Latest<Profiles> latest_;
};

}  // namespace dance

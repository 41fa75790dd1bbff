// Arrivals: short messages above the picture: a guest has joined, a guest has left. Guests present
// when the window opens are not announced. While the link has no session nothing is announced,
// because a missing guest may then be a network fault.
//
// Units/frames: MonoTime of the house's clock.
// Ownership:    plain values; bounded by DanceRecords::kMost guests and kMostShown messages.
// Threads:      the drawing thread.
#pragma once

#include <vector>

#include "viewer/dance_panel/dance_records.h"

namespace dance {

class Arrivals {
 public:
  static constexpr Duration kShown = Duration::s(5);
  // The link publishes the guests of the room once a second.
  static constexpr Duration kGone = Duration::s(3);
  // Arrivals are announced only this long after the window opened or the link's session began.
  static constexpr Duration kSettles = Duration::s(4);
  static constexpr std::size_t kMostShown = 3;

  struct Message {
    GuestId guest;
    bool has_joined = true;  // else left
    MonoTime at;
  };
  // Call it once a picture.
  void work(const DanceRecords& records, MonoTime now);
  // The newest messages, in the order of time.
  const std::vector<Message>& messages() const { return messages_; }

 private:
  void add(const GuestId& guest, bool has_joined, MonoTime now);

  std::vector<GuestId> here_;  // by name
  std::vector<Message> messages_;
  MonoTime connected_;  // when the session began; not set: there is none
};

}  // namespace dance

// Chat, both ways. The newest lines and signs of each guest of this house travel as one state of
// that guest. Each line or sign of another guest is delivered once, oldest first.
//
// Units/frames: now is MonoTime of this house's clock; on the way times are the server's.
// Ownership:    refers to the link's context; remembers kMostGuests guests. Never allocates.
// Threads:      none inside; one owner.
// Failure:      malformed chat, chat above the guest's rate, and chat older than kHolds is dropped.
//               The first two are counted.
#pragma once

#include "tunnel/link/core/link_context.h"

namespace dance {

class LinkChat {
 public:
  // Guests who join within this time still receive a line.
  static constexpr Duration kHolds = Duration::s(30);

  explicit LinkChat(LinkContext& link) : link_(link) {}

  // True where the guest's state has changed.
  bool write(LocalGuest& guest, const Chat& chat, MonoTime now);
  // False for a malformed state.
  bool deliver(const GuestId& guest, wire::Bytes payload, MonoTime now);
  // Call it when a new session's clock is mapped: a restarted server has another clock.
  void map_times();

 private:
  static constexpr std::size_t kMostGuests = wire::kMaxGuestsPerRoom;
  // It outlives a session, so that a guest's line is not shown again after a lapse.
  struct Received {
    GuestId guest;
    std::optional<std::uint32_t> sequence;  // the newest received
    ChatBudget budget;
  };
  Received& received_of(const GuestId& guest);
  std::size_t encode(const LocalGuest& guest,
                     std::array<std::uint8_t, wire::kMaxStatePayload>& payload) const;

  LinkContext& link_;
  FixedList<Received, kMostGuests> received_;  // the guest received last is at the end
};

}  // namespace dance

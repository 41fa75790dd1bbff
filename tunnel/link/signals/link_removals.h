// Guests whom this house, a host, wants removed from the room: the server is asked until it
// answers.
//
// Units/frames: MonoTime of this house's clock.
// Ownership:    refers to the link's context; kMost wishes.
// Threads:      none inside; one owner.
// Failure:      on_answer() and on_rights() of what is malformed are false, and change nothing. A
//               server that does not know of removals does not answer: told after a while.
#pragma once

#include "tunnel/link/core/link_context.h"
#include "tunnel/wire/wire_removal.h"

namespace dance {

class LinkRemovals {
 public:
  static constexpr std::size_t kMost = 16;

  explicit LinkRemovals(LinkContext& link) : link_(link) {}

  // A number that was asked before is the same wish.
  void ask(const GuestId& guest, std::int32_t number);
  // Those that are not answered: with each ping.
  void repeat();
  bool on_answer(wire::Bytes body);
  bool on_rights(wire::Bytes body);

 private:
  struct Wish {
    GuestId guest;
    std::int32_t number = 0;
    int asked = 0;
  };
  void send(Wish& wish);
  void tell(std::int32_t number, RemovalVerdict verdict);

  LinkContext& link_;
  FixedList<Wish, kMost> wishes_;
  FixedList<std::int32_t, kMost> settled_;  // the last ones
};

}  // namespace dance

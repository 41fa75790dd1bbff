// Who is in the room, as the server says it: gives the others' slots their guests, and tells who
// came and who left.
//
// Units/frames: now is MonoTime of this house's clock.
// Ownership:    refers to the link's context.
// Threads:      none inside; one owner.
// Failure:      a malformed part is false, and nothing of it is taken.
#pragma once

#include "tunnel/link/core/link_context.h"

namespace dance {

class LinkRoster {
 public:
  explicit LinkRoster(LinkContext& link) : link_(link) {}

  bool on_roster(wire::Bytes body, MonoTime now);
  // A new session: guests who are there may stay, what was heard of them counts no more.
  void begin_session();
  // The whole roster is to be told again.
  void forget() { roster_ = RosterAssembly(); }
  std::uint32_t whole_version() const { return roster_.whole_version(); }

 private:
  void settle_slot(RemoteGuest& remote, const wire::RosterEntry* entry);
  void renew_decoder(RemoteGuest& remote);

  LinkContext& link_;
  RosterAssembly roster_;
};

}  // namespace dance

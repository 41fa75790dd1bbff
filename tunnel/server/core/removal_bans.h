// RemovalBans: whom hosts have removed from rooms of this server, and who is therefore refused for
// a while: a key of one name by its name; one that all of a room share by the names of the guests
// that were removed, as it tells nobody from another; and in either case that link.
//
// Units/frames: MonoTime of the server's clock.
// Ownership:    plain value of a fixed size. Of more than kMost the one that ends first goes.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <algorithm>
#include <optional>

#include "core/base/fixed_list.h"
#include "core/base/time.h"
#include "tunnel/server/core/access.h"
#include "tunnel/wire/wire_removal.h"

namespace dance {

// What servers of a cluster tell each other: a host wants the guest removed, or it is done.
struct RemovalNotice {
  GuestId guest;
  std::uint64_t link_token = 0;
  GuestId key;           // the guest's own; not set: one that all of a room share, or not known
  bool is_done = false;  // else the server through which the guest came is to do it
};

class RemovalBans {
 public:
  static constexpr std::size_t kMost = 64;

  void add(const wire::RoomName& room, const RemovalNotice& notice, MonoTime now) {
    for (std::size_t i = bans_.size(); i-- > 0;)
      if (now >= bans_[i].until || (bans_[i].room == room && bans_[i].notice.guest == notice.guest))
        bans_.erase_at(i);
    if (bans_.is_full())
      bans_.erase_at(static_cast<std::size_t>(
          std::min_element(bans_.begin(), bans_.end(),
                           [](const Ban& a, const Ban& b) { return a.until < b.until; }) -
          bans_.begin()));
    [[maybe_unused]] const bool pushed = bans_.try_push({room, notice, now + wire::kRemovedFor});
  }

  // Until when this link is refused in the room; nothing where it is not.
  std::optional<MonoTime> refused_until(const wire::RoomName& room, std::uint64_t link_token,
                                        const Access& access, const auto& guests,
                                        MonoTime now) const {
    std::optional<MonoTime> until;
    for (const Ban& ban : bans_)
      if (ban.room == room && now < ban.until && is_of(ban.notice, link_token, access, guests))
        until = std::max(until.value_or(ban.until), ban.until);
    return until;
  }

 private:
  struct Ban {
    wire::RoomName room;
    RemovalNotice notice;
    MonoTime until;
  };

  static bool is_of(const RemovalNotice& notice, std::uint64_t link_token, const Access& access,
                    const auto& guests) {
    if (notice.link_token == link_token) return true;
    if (notice.key.is_set()) return !access.any_name && access.name == notice.key;
    return access.any_name && guests.contains(notice.guest);
  }

  FixedList<Ban, kMost> bans_;
};

}  // namespace dance

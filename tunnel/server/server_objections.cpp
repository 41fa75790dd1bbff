// Why a link is not let into a room.
#include "tunnel/server/server_admission.h"

namespace dance {
namespace {

// Other servers of a cluster send several heartbeats in this time.
constexpr Duration kRemoteSilence = Duration::ms(1000);

}  // namespace

std::optional<ServerAdmission::Objection> ServerAdmission::objection_to(
    const wire::Hello& hello, const Access& access, std::optional<std::size_t> existing,
    std::optional<std::size_t> room, MonoTime now) const {
  if (access.is_expired) return Objection{wire::Refusal::kKeyExpired, {}};
  if (!access.may_enter(hello.room)) return Objection{wire::Refusal::kNotAllowedRoom, {}};
  if (const auto until =
          server_.bans.refused_until(hello.room, hello.token, access, hello.guests, now))
    return Objection{wire::Refusal::kRemoved, {}, *until - now};
  if (!hello.guests.empty() && !may_have_guests(access))
    return Objection{wire::Refusal::kOnlyListens, {}};
  for (const GuestId& guest : hello.guests) {
    const bool is_others =
        access.any_name && access.role != Role::kHost && is_reserved_ && is_reserved_(guest);
    if (is_others || !access.may_use_name(guest))
      return Objection{wire::Refusal::kNotAllowedName, guest};
  }
  if (const auto full = server_.full_for(access, !existing, !room)) return Objection{*full, {}};
  if (room && !hello.codecs.contains(server_.rooms[*room].codec))
    return Objection{wire::Refusal::kCodec, {}};
  if (!room) return objection_to_guests(hello, access, existing, nullptr, now);
  if (hello.guests.empty())
    if (const auto full = full_for_listener(access, existing, server_.rooms[*room]))
      return Objection{*full, {}};
  return objection_to_guests(hello, access, existing, &server_.rooms[*room], now);
}

// Why the room has no place for one more link without guests.
std::optional<wire::Refusal> ServerAdmission::full_for_listener(const Access& access,
                                                                std::optional<std::size_t> existing,
                                                                const ServerRoom& room) const {
  std::size_t listeners = 0, of_key = 0;
  for (const std::size_t member : room.members) {
    const ServerSession& session = server_.sessions[member];
    if (member == existing || session.is_remote() || !session.slots.empty()) continue;
    ++listeners;
    of_key += session.access.name == access.name ? 1 : 0;
  }
  if (listeners >= server_.limits.listeners_per_room) return wire::Refusal::kListenersFull;
  if (of_key >= quota_of(access, server_.limits).listeners) return wire::Refusal::kKeyGuests;
  return std::nullopt;
}

// Whether the names are free, and whether the room and the key have places for all of the guests.
// `room` is null if the hello opens it.
std::optional<ServerAdmission::Objection> ServerAdmission::objection_to_guests(
    const wire::Hello& hello, const Access& access, std::optional<std::size_t> existing,
    const ServerRoom* room, MonoTime now) const {
  // Other guests: all, those through links of this server, and those in the slots that such links
  // may have.
  std::size_t all = 0, here = 0, taken = 0;
  std::size_t all_of_key = 0, here_of_key = 0;
  for (std::size_t slot = 0; room != nullptr && slot < room->guests.size(); ++slot) {
    const ServerGuest& guest = room->guests[slot];
    if (!guest.in_use || (existing && guest.owner == *existing)) continue;
    if (hello.guests.contains(guest.id) && may_take_over(guest, hello.token, now)) continue;
    if (hello.guests.contains(guest.id)) return Objection{wire::Refusal::kNameTaken, guest.id};
    const bool is_here = server_.is_local(guest), has_key = guest.key.name == access.name;
    ++all;
    here += is_here ? 1 : 0;
    taken += slot < wire::kSlotsPerPage ? 1 : 0;
    all_of_key += has_key ? 1 : 0;
    here_of_key += is_here && has_key ? 1 : 0;
  }
  const std::size_t more = hello.guests.size();
  if (here + more > server_.limits.guests_per_room || all + more > wire::kMaxGuestsPerRoom ||
      taken + more > wire::kSlotsPerPage)
    return Objection{wire::Refusal::kRoomFull, {}};
  const KeyQuota quota = quota_of(access, server_.limits);
  if (here_of_key + more > quota.guests || all_of_key + more > quota.guests_of_cluster)
    return Objection{wire::Refusal::kKeyGuests, {}};
  return std::nullopt;
}

// A guest of another server: its link has come here, or that server is gone.
bool ServerAdmission::may_take_over(const ServerGuest& guest, std::uint64_t link_token,
                                    MonoTime now) const {
  const ServerSession& owner = server_.sessions[guest.owner];
  return owner.is_remote() &&
         (guest.link_token == link_token || now - owner.last_heard > kRemoteSilence);
}

}  // namespace dance

// Who gets which of the records that come in.
#include "core/base/assert.h"
#include "tunnel/server/server_core.h"

namespace dance {
namespace {

// How long a receiver without anything to refer to waits before what was asked for is asked for
// again.
constexpr Duration kStillIsLate = Duration::ms(250);

}  // namespace

void ServerCore::on_interest(std::size_t index, wire::Bytes body, MonoTime now) {
  const auto list = wire::parse_interest_list(body);
  if (!list) return reject(ServerReject::kMalformed);
  ServerSession& session = sessions_[index];
  const bool is_newer =
      session.interest.version == 0 || is_newer_sequence(list->version, session.interest.version);
  if (is_newer) {
    session.interest = *list;
    settle_interest(index, now);
  }
  std::array<std::uint8_t, 16> out;
  send(session.peer, {out.data(), wire::build_interest_ack(session.interest.version, out)});
}

void ServerCore::settle_interest(std::size_t index, MonoTime now) {
  ServerSession& session = sessions_[index];
  const ServerRoom& room = rooms_[session.room];
  std::array<std::uint8_t, wire::kMaxGuestsPerRoom> dividers;
  dividers.fill(session.interest.default_divider);
  // An entry about who had the slot before says nothing about who has it now.
  for (const wire::InterestEntry& entry : session.interest.entries)
    if (room.guests[entry.slot.slot].generation == entry.slot.generation)
      dividers[entry.slot.slot] = entry.divider;
  session.full_shares = 0;
  for (std::uint8_t slot = 0; slot < dividers.size(); ++slot) {
    const ServerGuest& guest = room.guests[slot];
    if (!guest.in_use || guest.owner == index) continue;
    set_divider(index, slot, dividers[slot], now);
    if (dividers[slot] == 1) ++session.full_shares;
  }
}

void ServerCore::set_divider(std::size_t index, std::uint8_t slot, std::uint8_t divider,
                             MonoTime now) {
  ServerSession& session = sessions_[index];
  ServerGuest& guest = rooms_[session.room].guests[slot];
  InterestFilter& filter = session.filters[slot];
  if (filter.divider() == divider) return;
  schedule_feedback(guest.owner, now);
  if (filter.set_divider(divider, guest.poses.stream())) want_key_frame(guest, now);
}

bool ServerCore::wants_any_of(const ServerSession& receiver, const ServerSession& sender) const {
  return std::any_of(sender.slots.begin(), sender.slots.end(),
                     [&](std::uint8_t slot) { return receiver.filters[slot].wants_any(); });
}

bool ServerCore::take_share(std::size_t to, const wire::Record& record, MonoTime now) {
  ServerSession& session = sessions_[to];
  ServerGuest& guest = rooms_[session.room].guests[record.slot];
  InterestFilter& filter = session.filters[record.slot];
  if (filter.take(record, guest.counts())) return true;
  const bool is_late = !guest.key_asked_at.is_set() || now - guest.key_asked_at > kStillIsLate;
  if (record.kind == wire::RecordKind::kPose && filter.awaits_intra() && is_late &&
      !guest.key_wanted && filter.wants_any())
    want_key_frame(guest, now);
  return false;
}

}  // namespace dance

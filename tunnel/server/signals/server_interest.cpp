#include "tunnel/server/signals/server_interest.h"

#include <algorithm>
#include <utility>

#include "core/base/sequence.h"

namespace dance {
namespace {

// How long a receiver without anything to refer to waits before what was asked for is asked for
// again.
constexpr Duration kIntraIsLate = Duration::ms(250);

}  // namespace

void ServerInterest::on_interest(std::size_t index, wire::Bytes body, MonoTime now) {
  const auto list = wire::parse_interest_list(body);
  if (!list) return server_.reject(ServerReject::kMalformed);
  ServerSession& session = server_.sessions[index];
  const bool is_newer =
      session.interest.version == 0 || is_newer_sequence(list->version, session.interest.version);
  if (is_newer) {
    session.interest = *list;
    settle(index, now);
  }
  std::array<std::uint8_t, 16> out;
  server_.send(session.peer, {out.data(), wire::build_interest_ack(session.interest.version, out)});
}

void ServerInterest::settle(std::size_t index, MonoTime now) {
  ServerSession& session = server_.sessions[index];
  ServerRoom& room = server_.rooms[session.room];
  std::array<std::uint8_t, wire::kMaxGuestsPerRoom> dividers;
  dividers.fill(session.interest.default_divider);
  // An entry about who had the slot before says nothing about who has it now.
  for (const wire::InterestEntry& entry : session.interest.entries)
    if (room.guests[entry.slot.slot].generation == entry.slot.generation)
      dividers[entry.slot.slot] = entry.divider;
  for (std::size_t slot = 0; slot < dividers.size(); ++slot)
    if (dividers[slot] != 0) dividers[slot] = std::max(dividers[slot], session.pace.dividers[slot]);
  settle_voices(session, room);
  session.full_shares = 0;
  for (std::uint8_t slot = 0; slot < dividers.size(); ++slot) {
    const ServerGuest& guest = room.guests[slot];
    if (!guest.in_use || guest.owner == index) continue;
    set_divider(index, slot, dividers[slot], now);
    if (dividers[slot] == 1) ++session.full_shares;
  }
  if (room.remote_count > 0) {
    room.interest_changed = true;
    server_.mark_changed(room);
  }
}

void ServerInterest::settle_voices(ServerSession& session, const ServerRoom& room) {
  const wire::VoiceInterest& voices = session.interest.voices;
  if (voices.hears_others)
    session.voice.muted.reset();
  else
    session.voice.muted.set();
  for (const wire::Slot& slot : voices.exceptions)
    if (room.guests[slot.slot].generation == slot.generation)
      session.voice.muted.set(slot.slot, voices.hears_others);
}

void ServerInterest::tell_wanted(ServerRoom& room) {
  room.interest_changed = false;
  for (std::uint8_t slot = 0; slot < room.guests.size(); ++slot) {
    ServerGuest& guest = room.guests[slot];
    if (!guest.in_use || server_.is_local(guest)) continue;
    const bool is_wanted = std::ranges::any_of(room.members, [&](std::size_t member) {
      const ServerSession& session = server_.sessions[member];
      return !session.is_remote() && session.filters[slot].wants_any();
    });
    if (std::exchange(guest.is_wanted, is_wanted) != is_wanted)
      server_.cluster->on_wanted(room, guest, is_wanted);
  }
}

void ServerInterest::set_divider(std::size_t index, std::uint8_t slot, std::uint8_t divider,
                                 MonoTime now) {
  ServerSession& session = server_.sessions[index];
  ServerGuest& guest = server_.rooms[session.room].guests[slot];
  InterestFilter& filter = session.filters[slot];
  if (filter.divider() == divider) return;
  feedback_.schedule(guest.owner, now);
  if (filter.set_divider(divider, guest.poses.stream())) feedback_.want_intra_frame(guest, now);
}

bool ServerInterest::take(std::size_t to, const wire::Record& record, MonoTime now) {
  ServerSession& session = server_.sessions[to];
  ServerGuest& guest = server_.rooms[session.room].guests[record.slot];
  InterestFilter& filter = session.filters[record.slot];
  if (filter.take(record, guest.counts())) return true;
  const bool is_late = !guest.intra_asked_at.is_set() || now - guest.intra_asked_at > kIntraIsLate;
  if (record.kind == wire::RecordKind::kPose && filter.awaits_intra() && is_late &&
      !guest.intra_wanted && filter.wants_any())
    feedback_.want_intra_frame(guest, now);
  return false;
}

}  // namespace dance

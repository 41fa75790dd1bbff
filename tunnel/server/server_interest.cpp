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
  Thinning& thinning = session.thinning[slot];
  if (thinning.divider == divider) return;
  const Share before = share_of(thinning.divider);
  const Share after = share_of(divider);
  thinning.divider = divider;
  schedule_feedback(guest.owner, now);
  if (before == Share::kNone) session.held[slot].clear();  // what it has is old
  if (before == after || after == Share::kNone) return;
  // Who had everything has what base frames refer to; all others begin with a frame that needs
  // none.
  const bool is_served = before == Share::kAll && session.held[slot].is_of(guest.poses.stream());
  if (after == Share::kBase && is_served) return;
  thinning.awaits_still = true;
  if (after != Share::kStills || before == Share::kNone) want_key_frame(guest, now);
}

bool ServerCore::wants_any_of(const ServerSession& receiver, const ServerSession& sender) const {
  return std::any_of(sender.slots.begin(), sender.slots.end(),
                     [&](std::uint8_t slot) { return receiver.thinning[slot].divider != 0; });
}

bool ServerCore::is_in_share(const Thinning& thinning, const ServerGuest& guest,
                             const wire::Record& record) const {
  const Share share = share_of(thinning.divider);
  if (share == Share::kNone) return false;
  // What a message means is not known: whether the others can do without it neither.
  if (record.kind == wire::RecordKind::kChannel) return true;
  if (record.kind == wire::RecordKind::kHands) return guest.hands_count % thinning.divider == 0;
  if (thinning.awaits_still) return record.needs_no_other;
  if (share == Share::kAll) return true;
  if (share == Share::kStills)
    return record.needs_no_other && record.sequence - thinning.last_sent >= thinning.divider;
  // The sender's base frames come as often as the most eager wants them: of those each 2^n-th, the
  // same for all who want so many.
  const std::uint8_t wanted = spacing_log2(thinning.divider);
  const std::uint8_t told = guest.told.base_log2;
  const std::uint32_t each = wanted > told && told != 0 ? 1u << (wanted - told) : 1;
  return record.is_base && guest.base_count % each == 0;
}

bool ServerCore::take_share(std::size_t to, const wire::Record& record, MonoTime now) {
  ServerSession& session = sessions_[to];
  ServerGuest& guest = rooms_[session.room].guests[record.slot];
  Thinning& thinning = session.thinning[record.slot];
  const bool goes = is_in_share(thinning, guest, record);
  if (record.kind != wire::RecordKind::kPose) return goes;
  if (goes) {
    thinning.awaits_still = false;
    thinning.last_sent = record.sequence;
    return true;
  }
  ++thinning.left_out;
  thinning.last_left_out = static_cast<std::uint16_t>(record.sequence);
  thinning.tells_left_out = true;
  const bool is_late = !guest.key_asked_at.is_set() || now - guest.key_asked_at > kStillIsLate;
  if (thinning.awaits_still && is_late && !guest.key_wanted && thinning.divider != 0)
    want_key_frame(guest, now);
  return false;
}

void ServerCore::tell_left_out(ServerSession& to, wire::Record& record) {
  Thinning& thinning = to.thinning[record.slot];
  if (record.kind != wire::RecordKind::kPose || !thinning.tells_left_out) return;
  // It has one that told the whole count.
  const HeldFrames& held = to.held[record.slot];
  if (held.is_of(record.stream) &&
      static_cast<std::int16_t>(held.newest() - thinning.last_left_out) > 0) {
    thinning.tells_left_out = false;
    return;
  }
  record.counts_left_out = true;
  record.left_out = thinning.left_out;
}

}  // namespace dance

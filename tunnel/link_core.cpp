#include "tunnel/link_core.h"

#include <algorithm>

#include "core/base/assert.h"

namespace dance {

LinkCore::LinkCore(const LinkOptions& options, LinkHandlers handlers, DatagramSink& sink)
    : options_(options),
      handlers_(std::move(handlers)),
      sink_(sink),
      random_(options.seed),
      remotes_(wire::kMaxGuestsPerRoom) {
  DANCE_ASSERT(options.token != 0);
  DANCE_ASSERT(options.room.is_set());
  if (options_.codecs.empty())
    for (const CodecId id : known_codecs()) {
      const bool pushed = options_.codecs.try_push(static_cast<std::uint8_t>(id));
      DANCE_ASSERT(pushed);
    }
  locals_.reserve(wire::kMaxGuestsPerLink);
  for (const GuestId& id : options_.guests) {
    locals_.emplace_back();
    locals_.back().id = id;
  }
}

void LinkCore::send_datagram(wire::Bytes bytes) {
  DANCE_ASSERT(!bytes.empty());
  ++counters_.datagrams_out;
  counters_.bytes_out += bytes.size();
  sink_.send({}, bytes);
}

void LinkCore::deliver_state(LinkState state, MonoTime now) {
  if (state_ == state) return;
  state_ = state;
  if (handlers_.on_state) handlers_.on_state(state, now);
}

// By the slot where we have one; by the name only while our own hello for it is under way, as
// another link may have a guest of the same name, which is then not ours.
bool LinkCore::is_ours(const wire::RosterEntry& entry) const {
  return std::any_of(locals_.begin(), locals_.end(), [&](const LocalGuest& guest) {
    if (guest.has_slot)
      return guest.slot.slot == entry.slot.slot && guest.slot.generation == entry.slot.generation;
    return guest.id == entry.guest && !guest.refused_until.is_set();
  });
}

LocalGuest* LinkCore::find_or_add(const GuestId& id, MonoTime now) {
  for (LocalGuest& guest : locals_)
    if (guest.id == id) return &guest;
  if (locals_.size() == wire::kMaxGuestsPerLink) {
    ++counters_.overflow;
    return nullptr;
  }
  locals_.emplace_back();
  locals_.back().id = id;
  schedule_update(now);
  return &locals_.back();
}

void LinkCore::receive(wire::Bytes datagram, MonoTime received, MonoTime now) {
  ++counters_.datagrams_in;
  counters_.bytes_in += datagram.size();
  const auto opening = wire::parse_opening(datagram);
  if (!opening) {
    ++counters_.rejected_datagrams;
    return;
  }
  if (opening->has_magic) {
    if (opening->type == wire::Type::kWelcome) return on_welcome(*opening, received, now);
    if (opening->type == wire::Type::kRefusal) return on_refusal(*opening, now);
    ++counters_.rejected_datagrams;
    return;
  }
  const bool is_good =
      session_ != 0 && opening->session == session_ && on_session_datagram(*opening, received, now);
  if (!is_good) ++counters_.rejected_datagrams;
}

void LinkCore::fill(Stats& stats) const {
  const LinkCounters& c = counters_;
  const auto as_signed = [](std::uint64_t n) { return static_cast<std::int64_t>(n); };
  stats.received = as_signed(c.poses_offered + c.poses_received);
  stats.forwarded = as_signed(c.poses_sent + c.poses_delivered);
  stats.dropped_late = as_signed(c.late);
  stats.dropped_invalid = as_signed(c.invalid);
  stats.dropped_unrouted = as_signed(c.unrouted);
  stats.dropped_overflow = as_signed(c.overflow);
  stats.lost = 0;
  stats.guests = 0;
  for (const RemoteGuest& remote : remotes_) {
    if (!remote.in_use || remote.is_ours) continue;
    ++stats.guests;
    stats.lost += as_signed(remote.poses.counters().lost);
  }
  stats.bytes_in = as_signed(c.bytes_in);
  stats.bytes_out = as_signed(c.bytes_out);
  stats.datagrams_in = as_signed(c.datagrams_in);
  stats.datagrams_out = as_signed(c.datagrams_out);
  stats.rejected_datagrams = as_signed(c.rejected_datagrams);
  stats.sessions = is_connected() ? 1 : 0;
  stats.reconnects = as_signed(c.reconnects);
  stats.round_trip = clock_.newest_round_trip();
  stats.clock_offset = clock_.offset();
}

std::vector<RemoteGuestStats> LinkCore::remote_stats() const {
  std::vector<RemoteGuestStats> all;
  for (const RemoteGuest& remote : remotes_) {
    if (!remote.in_use || remote.is_ours) continue;
    const StreamGate::Counters& c = remote.poses.counters();
    all.push_back({remote.id, c.received, c.lost, c.late, c.duplicate, remote.invalid});
  }
  return all;
}

}  // namespace dance

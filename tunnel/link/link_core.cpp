#include "tunnel/link/link_core.h"

#include <algorithm>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr std::size_t kMostDeparted = 64;

RemoteGuestStats stats_of(const RemoteGuest& remote) {
  const StreamGate::Counters& c = remote.poses.counters();
  return {remote.id,
          true,
          c.received,
          c.lost,
          c.late,
          c.duplicate,
          remote.invalid,
          remote.reference_missing,
          remote.skeleton_missing,
          remote.key_frames_asked};
}

void add(const RemoteGuestStats& more, RemoteGuestStats& sum) {
  sum.received += more.received;
  sum.lost += more.lost;
  sum.late += more.late;
  sum.duplicate += more.duplicate;
  sum.invalid += more.invalid;
  sum.reference_missing += more.reference_missing;
  sum.skeleton_missing += more.skeleton_missing;
  sum.key_frames_asked += more.key_frames_asked;
}

}  // namespace

LinkCore::LinkCore(const LinkOptions& options, LinkHandlers handlers, DatagramSink& sink)
    : options_(options),
      handlers_(std::move(handlers)),
      sink_(sink),
      random_(options.seed),
      remotes_(wire::kMaxGuestsPerRoom) {
  DANCE_ASSERT(options.token != 0);
  DANCE_ASSERT(options.room.is_set());
  DANCE_ASSERT(!options.listen_only || options.guests.empty());
  if (options_.codecs.empty())
    for (const CodecName& name : known_codecs()) {
      const bool pushed = options_.codecs.try_push(name);
      DANCE_ASSERT(pushed);
    }
  locals_.reserve(wire::kMaxGuestsPerLink);
  departed_.reserve(kMostDeparted);
  channels_.reserve(kMaxHouseChannels);
  announce_streams();
  for (const GuestId& id : options_.guests) add_local(id);
}

LocalGuest& LinkCore::add_local(const GuestId& id) {
  LocalGuest& guest = locals_.emplace_back();
  guest.id = id;
  guest.quality = QualityByRate(options_.quality_m, options_.pose_bytes_per_second);
  return guest;
}

void LinkCore::send_datagram(wire::Bytes bytes) {
  DANCE_ASSERT(!bytes.empty());
  ++counters_.datagrams_out;
  counters_.bytes_out += bytes.size() + wire::kSealOverhead;
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
  for (LocalGuest& guest : locals_) {
    if (guest.id != id) continue;
    guest.last_pose = now;
    return &guest;
  }
  if (options_.listen_only) {
    ++counters_.unrouted;
    return nullptr;
  }
  if (locals_.size() == wire::kMaxGuestsPerLink) {
    ++counters_.overflow;
    return nullptr;
  }
  LocalGuest& guest = add_local(id);
  guest.came_with_pose = true;
  guest.last_pose = now;
  schedule_update(now);
  return &guest;
}

void LinkCore::receive(wire::Bytes datagram, MonoTime received, MonoTime now) {
  ++counters_.datagrams_in;
  counters_.bytes_in += datagram.size() + wire::kSealOverhead;
  const auto opening = wire::parse_opening(datagram);
  if (!opening) {
    ++counters_.rejected_datagrams;
    return;
  }
  if (opening->type == wire::Type::kWelcome) return on_welcome(opening->body, received, now);
  if (opening->type == wire::Type::kRefusal) return on_refusal(opening->body, now);
  // Anything else that comes before the welcome is of the sealed session before.
  if (!is_welcome_ || !on_session_datagram(*opening, received, now)) ++counters_.rejected_datagrams;
}

void LinkCore::fill(Stats& stats) const {
  const LinkCounters& c = counters_;
  const auto as_signed = [](std::uint64_t n) { return static_cast<std::int64_t>(n); };
  stats.received = as_signed(c.poses_offered + c.poses_received);
  stats.forwarded = as_signed(c.poses_sent + c.poses_delivered);
  stats.dropped_late = as_signed(c.late);
  stats.dropped_invalid = as_signed(c.invalid + c.reference_missing + c.skeleton_missing);
  stats.dropped_unrouted = as_signed(c.unrouted);
  stats.dropped_overflow = as_signed(c.overflow);
  stats.lost = 0;
  stats.guests = 0;
  for (const RemoteGuest& remote : remotes_) {
    if (!remote.in_use || remote.is_ours) continue;
    ++stats.guests;
    stats.lost += as_signed(remote.poses.counters().lost);
  }
  for (const RemoteGuestStats& departed : departed_) stats.lost += as_signed(departed.lost);
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

// Before a guest's counting begins anew: it left, or it came back in another slot or session.
void LinkCore::keep_counts(const RemoteGuest& remote) {
  if (!remote.in_use || remote.is_ours) return;
  RemoteGuestStats counts = stats_of(remote);
  counts.is_here = false;
  for (RemoteGuestStats& known : departed_)
    if (known.guest == counts.guest) return add(counts, known);
  if (departed_.size() == kMostDeparted) departed_.erase(departed_.begin());
  departed_.push_back(counts);
}

std::vector<RemoteGuestStats> LinkCore::remote_stats() const {
  std::vector<RemoteGuestStats> all = departed_;
  for (const RemoteGuest& remote : remotes_) {
    if (!remote.in_use || remote.is_ours) continue;
    const auto known = std::find_if(all.begin(), all.end(), [&](const RemoteGuestStats& stats) {
      return stats.guest == remote.id;
    });
    if (known == all.end()) {
      all.push_back(stats_of(remote));
    } else {
      add(stats_of(remote), *known);
      known->is_here = true;
    }
  }
  return all;
}

std::vector<LocalGuestStats> LinkCore::local_stats() const {
  std::vector<LocalGuestStats> all;
  for (const LocalGuest& guest : locals_)
    all.push_back({guest.id, guest.references.references(), guest.references.sent(),
                   guest.references.acked(), guest.references.intra_asked(),
                   guest.quality.quality_m()});
  return all;
}

}  // namespace dance

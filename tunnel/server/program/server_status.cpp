#include "tunnel/server/program/server_status.h"

#include <algorithm>
#include <map>
#include <set>

#include "tunnel/session/profile_bytes.h"

namespace dance {
namespace {

// Share of `lost` among all; a guest who left takes its counts along, so that a change may be
// negative.
std::optional<double> share(std::int64_t lost, std::int64_t came) {
  lost = std::max<std::int64_t>(lost, 0);
  if (came <= 0 && lost == 0) return std::nullopt;
  return static_cast<double>(lost) / static_cast<double>(lost + std::max<std::int64_t>(came, 0));
}

// The server forwards the profile as the message of a channel, and reads it here alone.
ShownName shown_name_of(const ServerGuest& guest) {
  for (std::size_t at = wire::kFirstChannelPlace; at < wire::kGuestStates; ++at) {
    const RetainedState& state = guest.states[at];
    if (state.version == 0) continue;
    const auto channel = wire::parse_channel(state.bytes());
    if (!channel || !channel->name.view().starts_with(kProfilePrefix)) continue;
    if (const auto profile = parse_profile(channel->message)) return profile->shown_name;
  }
  return {};
}

std::int64_t change(std::uint64_t before, std::uint64_t after) {
  return static_cast<std::int64_t>(after - before);
}

}  // namespace

const ServerStatusMaker::Sample* ServerStatusMaker::History::oldest() const {
  return count == 0 ? nullptr : &ring[count < ring.size() ? 0 : count % ring.size()];
}

ServerStatusMaker::ServerStatusMaker(const ServerCore& core, const ServerLimits& limits,
                                     std::string address, PeerText peer_text, MonoTime begin)
    : core_(core),
      limits_(limits),
      address_(std::move(address)),
      peer_text_(std::move(peer_text)),
      begin_(begin),
      histories_(core.sessions().size()) {
  static_assert(kStatusWindow.count_ms() == 1000 * std::tuple_size_v<decltype(History::ring)>);
}

ServerStatusMaker::Sample ServerStatusMaker::sample_of(const ServerSession& session,
                                                       MonoTime now) const {
  Sample sample;
  sample.at = now;
  sample.meter = session.meter;
  for (const std::uint8_t slot : session.slots) {
    const StreamGate::Counters& poses = core_.rooms()[session.room].guests[slot].poses.counters();
    sample.poses_up += poses.received;
    sample.lost_up += poses.lost;
    sample.voices_up += core_.rooms()[session.room].guests[slot].voice.packets_in;
  }
  sample.voices_down = session.voice.packets_out;
  sample.has_ping = session.newest_ping.sequence != 0;
  sample.poses_down = session.newest_ping.poses_received;
  sample.lost_down = session.newest_ping.poses_lost;
  return sample;
}

void ServerStatusMaker::sample(MonoTime now) {
  for (std::size_t i = 0; i < histories_.size(); ++i) {
    const ServerSession& session = core_.sessions()[i];
    History& history = histories_[i];
    if (!session.in_use || history.since != session.meter.since) history.count = 0;
    history.since = session.meter.since;
    if (!session.in_use || !session.meter.since.is_set()) continue;
    history.ring[history.count++ % history.ring.size()] = sample_of(session, now);
    // Bounded: full once and full twice are the same to oldest().
    if (history.count == 2 * history.ring.size()) history.count = history.ring.size();
  }
}

ServerLinkStatus ServerStatusMaker::link_status(std::size_t index, MonoTime now) const {
  const ServerSession& session = core_.sessions()[index];
  const Sample after = sample_of(session, now);
  Sample before;  // nothing, at the link's begin
  before.at = session.meter.since;
  const History& history = histories_[index];
  if (history.since == session.meter.since && history.oldest() != nullptr)
    before = *history.oldest();

  ServerLinkStatus link;
  link.peer = peer_text_(session);
  link.key = session.access.name.view();
  link.key_until_utc_s = session.access.until_s;
  link.age = now - session.meter.since;
  link.last_heard = std::max(Duration(), now - session.last_heard);
  if (session.newest_ping.round_trip_us != 0)
    link.round_trip = Duration::us(session.newest_ping.round_trip_us);
  link.poses_lost = session.newest_ping.poses_lost;
  if (session.pace.budget.is_limited())
    link.budget_bytes_per_s = session.pace.budget.bytes_per_second();
  link.share_window = limits_.share_window.value_or(session.pace.window);
  link.thinned = static_cast<std::size_t>(
      std::count_if(session.pace.dividers.begin(), session.pace.dividers.end(),
                    [](std::uint8_t divider) { return divider > 1; }));
  link.bytes_in = session.meter.bytes_in;
  link.bytes_out = session.meter.bytes_out;
  // Shorter than this, one datagram would look like a stream.
  const double seconds = std::max((now - before.at).as_seconds(), 0.5);
  const auto rate = [&](std::uint64_t LinkMeter::*what) {
    return static_cast<double>(after.meter.*what - before.meter.*what) / seconds;
  };
  link.datagrams_in_per_s = rate(&LinkMeter::datagrams_in);
  link.datagrams_out_per_s = rate(&LinkMeter::datagrams_out);
  link.bytes_in_per_s = rate(&LinkMeter::bytes_in);
  link.bytes_out_per_s = rate(&LinkMeter::bytes_out);
  // A guest who left took its count along.
  const auto voices = [&](std::uint64_t from, std::uint64_t to) {
    return static_cast<double>(std::max<std::int64_t>(change(from, to), 0)) / seconds;
  };
  link.voices_in_per_s = voices(before.voices_up, after.voices_up);
  link.voices_out_per_s = voices(before.voices_down, after.voices_down);
  link.voice_bytes_out = session.voice.bytes_out;
  link.loss_up =
      share(change(before.lost_up, after.lost_up), change(before.poses_up, after.poses_up));
  // The link counts from its own begin, which may be before the session's.
  if (before.has_ping && after.has_ping)
    link.loss_down = share(sequence_ahead(before.lost_down, after.lost_down),
                           sequence_ahead(before.poses_down, after.poses_down));

  for (const std::uint8_t slot : session.slots) {
    const ServerGuest& guest = core_.rooms()[session.room].guests[slot];
    const StreamGate::Counters& poses = guest.poses.counters();
    ServerGuestStatus status{
        guest.id,     poses.received,         poses.lost,           poses.late,
        std::nullopt, guest.voice.packets_in, guest.voice.bytes_in, shown_name_of(guest)};
    if (guest.jitter.has_any()) {
      status.jitter = guest.jitter.jitter();
      link.jitter = std::max(link.jitter.value_or(Duration()), *status.jitter);
    }
    link.guests.push_back(std::move(status));
  }
  return link;
}

ServerStatus ServerStatusMaker::make(MonoTime now, std::span<const NamedCount> handshakes) const {
  ServerStatus status;
  status.version = server_version();
  status.address = address_;
  status.uptime = now - begin_;
  status.totals = core_.counters();
  for (std::size_t i = 0; i < kServerRejects; ++i)
    status.rejects.push_back({std::string(kServerRejectNames[i]), status.totals.rejected[i]});
  status.handshakes.assign(handshakes.begin(), handshakes.end());
  for (const ServerRoom& room : core_.rooms()) {
    if (!room.in_use) continue;
    ServerRoomStatus about;
    about.name = room.name;
    about.codec = room.codec;
    for (const std::size_t member : room.members) {
      // Who has said no more than hello may be nobody.
      if (!core_.sessions()[member].meter.since.is_set()) continue;
      about.links.push_back(link_status(member, now));
      about.share_window = std::max(about.share_window, about.links.back().share_window);
      about.guests += about.links.back().guests.size();
      about.listeners += about.links.back().guests.empty() ? 1 : 0;
    }
    if (!about.links.empty()) status.rooms.push_back(std::move(about));
  }
  std::sort(status.rooms.begin(), status.rooms.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  status.keys = key_status(status.rooms);
  return status;
}

// Sorts by traffic, which costs others most, then by sessions; the largest comes first.
std::vector<ServerKeyStatus> ServerStatusMaker::key_status(
    const std::vector<ServerRoomStatus>& rooms) const {
  std::map<std::string_view, ServerKeyStatus> by_name;
  for (const ServerRoomStatus& room : rooms) {
    std::set<std::string_view> here;
    for (const ServerLinkStatus& link : room.links) {
      ServerKeyStatus& key = by_name[link.key];
      ++key.sessions;
      key.rooms += here.insert(link.key).second ? 1 : 0;
      key.bytes_in_per_s += link.bytes_in_per_s;
      key.bytes_out_per_s += link.bytes_out_per_s;
    }
  }
  std::vector<ServerKeyStatus> keys;
  for (auto& [name, key] : by_name) {
    key.name = name;
    if (const auto id = GuestId::parse(name)) key.avatar_bytes = core_.files().bytes_of_key(*id);
    keys.push_back(std::move(key));
  }
  std::ranges::stable_sort(keys, [](const ServerKeyStatus& a, const ServerKeyStatus& b) {
    const double of_a = a.bytes_in_per_s + a.bytes_out_per_s;
    const double of_b = b.bytes_in_per_s + b.bytes_out_per_s;
    return of_a != of_b ? of_a > of_b : a.sessions > b.sessions;
  });
  return keys;
}

}  // namespace dance

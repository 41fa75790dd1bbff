#include "tunnel/server/server_core.h"

#include <algorithm>

#include "core/base/assert.h"
#include "core/base/deadline.h"

namespace dance {
namespace {

constexpr Duration kTick = Duration::ms(100);
// The other servers are told again what may have been lost.
constexpr std::uint64_t kSweepsPerRepeat = 5;
// A host's link is told that it is one with its first ping, and again as that may be lost.
constexpr std::uint32_t kPingsPerRights = 8;

}  // namespace

std::size_t ServerCore::room_count() const {
  return static_cast<std::size_t>(std::count_if(server_.rooms.begin(), server_.rooms.end(),
                                                [](const auto& room) { return room.in_use; }));
}

std::size_t ServerCore::guest_count() const {
  std::size_t count = 0;
  for (const ServerSession& session : server_.sessions)
    if (session.in_use && !session.is_remote()) count += session.slots.size();
  return count;
}

std::size_t ServerCore::listener_count() const {
  return static_cast<std::size_t>(std::count_if(
      server_.sessions.begin(), server_.sessions.end(), [](const ServerSession& session) {
        return session.in_use && !session.is_remote() && session.slots.empty();
      }));
}

void ServerCore::receive(PeerId from, const Access& access, wire::Bytes datagram, MonoTime received,
                         MonoTime now) {
  DANCE_ASSERT(from != 0);
  ++server_.counters.datagrams_in;
  server_.counters.bytes_in += datagram.size() + wire::kSealOverhead;
  const auto opening = wire::parse_opening(datagram);
  if (!opening) return server_.reject(ServerReject::kTooShort);
  const auto found = server_.by_peer.find(from);
  if (found != server_.by_peer.end()) {
    ServerSession& session = server_.sessions[found->second];
    if (!server_.admits(session, datagram.size(), now)) return;
    session.meter.came_in(datagram.size() + wire::kSealOverhead, now);
  }
  // The answer to the link's next hello gives the reason.
  if (access.is_expired && found != server_.by_peer.end()) {
    server_.audit(from, {.kind = AuditKind::kRemoved,
                         .key = access.name.view(),
                         .room = server_.rooms[server_.sessions[found->second].room].name,
                         .cause = "key_expired"});
    keepalive_.send_goodbye(from);
    return admission_.drop(found->second);
  }
  if (opening->type == wire::Type::kHello)
    return admission_.on_hello(from, access, opening->body, received, now);
  if (opening->type == wire::Type::kRoomQuestion)
    return room_answers_.on_question(from, access, opening->body, now);
  // Its session fell silent and was dropped. Data of others that is still under way to it would
  // hide that from the link: it is told.
  if (found == server_.by_peer.end()) {
    if (opening->type == wire::Type::kPing) keepalive_.send_goodbye(from);
    return server_.reject(ServerReject::kNoSession);
  }
  on_session_datagram(found->second, *opening, received, now);
}

void ServerCore::forget(PeerId peer) {
  const auto found = server_.by_peer.find(peer);
  if (found != server_.by_peer.end()) admission_.drop(found->second);
}

void ServerCore::on_session_datagram(std::size_t index, const wire::Opening& opening,
                                     MonoTime received, MonoTime now) {
  ServerSession& session = server_.sessions[index];
  session.last_heard = now;
  ++session.datagrams_received;
  switch (opening.type) {
    case wire::Type::kPing:
      keepalive_.on_ping(index, opening.body, received, now);
      if (session.knows_epoch && session.newest_ping.sequence % kPingsPerRights == 1)
        removals_.tell_rights(index);
      return;
    case wire::Type::kRecords:
      return forwarder_.on_records(index, opening.body, received, now);
    case wire::Type::kVoices:
      return voice_.on_voices(index, opening.body, received, now);
    case wire::Type::kState:
      return states_.on_states(index, opening.body, now);
    case wire::Type::kStateAck:
      return states_.on_acks(index, opening.body);
    case wire::Type::kInterest:
      return interest_.on_interest(index, opening.body, now);
    case wire::Type::kRemoval:
      return removals_.on_request(index, opening.body, now);
    case wire::Type::kFileTerms:
      if (files_.on_terms(index, opening.body)) sync_.repeat_states(index);
      return;
    case wire::Type::kFileWant:
      return files_.on_want(index, opening.body, now);
    case wire::Type::kFileChunk:
      return files_.on_chunk(index, opening.body, now);
    case wire::Type::kFileRefusal:
      return files_.on_refusal(index, opening.body, now);
    case wire::Type::kGoodbye:
      if (!opening.body.empty()) return server_.reject(ServerReject::kMalformed);
      ++server_.counters.goodbyes;
      return admission_.drop(index);
    default:
      return server_.reject(ServerReject::kUnknownType);
  }
}

// Dancers first: what a newcomer, a state or a file needs may be much. What a newcomer is told
// includes poses, which are flushed at once.
void ServerCore::end_turn(MonoTime now) {
  tell_rosters(now);
  tell_wanted();
  forwarder_.flush_due(now);
  if (sync_newcomers(now)) forwarder_.flush_due(now);
  voice_.send_due(now);
  tell_fresh_states(now);
  files_.send_due(now);
  std::erase_if(server_.changed_rooms, [this](std::size_t i) {
    server_.rooms[i].is_listed =
        server_.rooms[i].roster_changed || server_.rooms[i].has_fresh_states;
    return !server_.rooms[i].is_listed;
  });
}

void ServerCore::tell_rosters(MonoTime now) {
  for (const std::size_t i : server_.changed_rooms) {
    ServerRoom& room = server_.rooms[i];
    if (!room.roster_changed) continue;
    room.roster_changed = false;
    for (const std::size_t member : room.members) {
      if (server_.sessions[member].is_remote()) continue;
      interest_.settle(member, now);
      if (!server_.is_newcomer(member)) sync_.send_roster(member);  // else sync_newcomers()
    }
  }
}

// In a cluster: whom this server's links want of the guests of other servers.
void ServerCore::tell_wanted() {
  for (const std::size_t i : server_.changed_rooms)
    if (server_.rooms[i].interest_changed && server_.rooms[i].in_use)
      interest_.tell_wanted(server_.rooms[i]);
}

bool ServerCore::sync_newcomers(MonoTime now) {
  const auto is_synced = [&](std::size_t newcomer) {
    ServerRoom& room = server_.rooms[server_.sessions[newcomer].room];
    if (room.settled_at.is_set() && now < room.settled_at) return false;
    room.settled_at = MonoTime();
    sync_.send_all(newcomer, now);
    return true;
  };
  return std::erase_if(server_.newcomers, is_synced) > 0;
}

void ServerCore::tell_fresh_states(MonoTime now) {
  for (const std::size_t i : server_.changed_rooms)
    if (server_.rooms[i].has_fresh_states && now >= server_.rooms[i].fresh_states_due)
      states_.send_fresh(server_.rooms[i], now);
}

void ServerCore::sweep(MonoTime now) {
  if (++sweeps_ % kSweepsPerRepeat == 0) remotes_.repeat_feedback(now);
  files_.forget_absent();
  pace_.sample(now);
  keepalive_.sweep(now);
}

MonoTime ServerCore::tick(MonoTime now) {
  if (now >= next_sweep_) {
    sweep(now);
    next_sweep_ = now + kTick;
  }
  end_turn(now);
  return next_deadline();
}

MonoTime ServerCore::next_deadline() const {
  if (server_.by_peer.empty()) return MonoTime();
  MonoTime next = next_sweep_.is_set() ? next_sweep_ : MonoTime::from_ns(1);
  for (const std::size_t i : server_.bundled)
    next = std::min(next, server_.sessions[i].stream.bundle.due());
  for (const std::size_t i : server_.reporting)
    if (server_.sessions[i].is_remote())
      next = std::min(next, server_.sessions[i].feedback_due);
    else if (server_.sessions[i].stream.bundle.is_empty())
      next = std::min(next, server_.sessions[i].feedback_alone);
  for (const std::size_t i : server_.changed_rooms)
    if (const ServerRoom& room = server_.rooms[i]; room.has_fresh_states)
      next = std::min(next, room.fresh_states_due);
  next = earlier(next, voice_.next_deadline());
  for (const std::size_t i : server_.newcomers)
    if (const MonoTime at = server_.rooms[server_.sessions[i].room].settled_at; at.is_set())
      next = std::min(next, at);
    else
      next = MonoTime::from_ns(1);  // its room is known: now
  return earlier(next, files_.next_deadline());
}

void ServerCore::end_sessions() {
  keepalive_.end_sessions();
  next_sweep_ = MonoTime();
}

}  // namespace dance

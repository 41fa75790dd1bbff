#include "tunnel/server/server_admission.h"

#include <algorithm>
#include <utility>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr std::uint64_t kLongestOvertaking_us = 60'000'000;
// Reading what lasts takes milliseconds, and seconds where NATS has just lost a server. Less than
// guests have to come back in, who would seem to leave otherwise.
constexpr Duration kSettlesWithin = Duration::s(4);

}  // namespace

ServerAdmission::ServerAdmission(ServerContext& server, ServerSlots& slots,
                                 ServerFeedback& feedback, ServerInterest& interest,
                                 RandomU64 random)
    : server_(server),
      slots_(slots),
      feedback_(feedback),
      interest_(interest),
      random_(std::move(random)) {
  hellos_.fill(TokenBucket(server.limits.hellos_per_second, server.limits.hello_burst));
}

// A token counts with the key that it came with: another key gets no place by it.
std::optional<std::size_t> ServerAdmission::find_token(std::uint64_t token,
                                                       const GuestId& key) const {
  for (std::size_t i = 0; i < server_.sessions.size(); ++i)
    if (server_.sessions[i].in_use && !server_.sessions[i].is_remote() &&
        server_.sessions[i].token == token && server_.sessions[i].access.name == key)
      return i;
  return std::nullopt;
}

std::optional<std::size_t> ServerAdmission::find_room(const wire::RoomName& name) const {
  const auto found = server_.by_room.find(name);
  return found != server_.by_room.end() ? std::optional(found->second) : std::nullopt;
}

void ServerAdmission::on_hello(PeerId from, const Access& access, wire::Bytes body,
                               MonoTime received, MonoTime now) {
  const std::size_t place = std::hash<std::string_view>()(access.name.view()) % hellos_.size();
  if (!hellos_[place].take(1.0, now)) return server_.reject(ServerReject::kSessionRate);
  wire::HelloProblem problem;
  const auto hello = wire::parse_hello(body, problem);
  if (!hello && problem.is_other_version)
    return refuse(from, access.name, {}, problem.nonce, wire::Refusal::kVersion, {});
  if (!hello && problem.is_bad_name)
    return refuse(from, access.name, {}, problem.nonce, wire::Refusal::kBadName, {});
  if (!hello) return server_.reject(ServerReject::kMalformed);

  auto existing = find_token(hello->token, access.name);
  if (existing) {
    // One that was overtaken on its way, by this sealed session or the one before. Nothing is
    // overtaken by a minute: then the time of the other was wrong.
    const ServerSession& session = server_.sessions[*existing];
    const std::uint64_t before_us = static_cast<std::uint64_t>(session.hello_time_us) -
                                    static_cast<std::uint64_t>(hello->link_time_us);
    if ((hello->link_time_us < session.hello_time_us && before_us < kLongestOvertaking_us) ||
        (hello->link_time_us == session.hello_time_us && session.peer != from))
      return server_.reject(ServerReject::kOldHello);
  }
  // A peer has one session: what it had under another token ends here.
  const auto own = server_.by_peer.find(from);
  if (own != server_.by_peer.end() && own->second != existing) drop(own->second);
  if (existing && server_.rooms[server_.sessions[*existing].room].name != hello->room) {
    drop(*existing);
    existing.reset();
  }
  auto room = find_room(hello->room);
  if (const auto objection = objection_to(*hello, access, existing, room, now)) {
    if (objection->cause == wire::Refusal::kRemoved) {
      audit_refusal(from, access.name, hello->room, objection->cause);
      return send_removal_notice(from, hello->nonce, objection->removed_for);
    }
    return refuse(from, access.name, hello->room, hello->nonce, objection->cause, objection->guest);
  }

  if (!room) room = open_room(access, *hello, now);
  const std::size_t index = existing ? *existing : open_session(from, access, *hello, *room);
  ServerSession& session = server_.sessions[index];
  const bool is_moved = session.peer != from;
  if (is_moved) {
    ++server_.counters.sessions_resumed;
    move_session(index, from);
  }
  settle_access(index, access);
  session.last_heard = now;
  session.hello_time_us = hello->link_time_us;
  const bool has_new_guests = settle_guests(index, *hello);
  if (!existing || has_new_guests)
    server_.audit(from, {.kind = AuditKind::kJoined,
                         .key = access.name.view(),
                         .room = hello->room,
                         .guests = hello->guests});
  if (!existing || is_moved) session.interest.default_divider = hello->default_divider;
  interest_.settle(index, now);
  welcome(index, *hello, received, now);
  if (!existing || is_moved) {
    if (!server_.is_newcomer(index)) server_.newcomers.push_back(index);
    feedback_.want_intra_frames_for(index, now);
  }
}

void ServerAdmission::welcome(std::size_t index, const wire::Hello& hello, MonoTime received,
                              MonoTime now) {
  const ServerSession& session = server_.sessions[index];
  const ServerRoom& room = server_.rooms[session.room];
  wire::Welcome welcome;
  welcome.nonce = hello.nonce;
  welcome.epoch = session.epoch;
  welcome.link_time_us = hello.link_time_us;
  welcome.server_receive_us = received.since_zero_us();
  welcome.server_send_us = std::max(now, received).since_zero_us();
  welcome.codec = room.codec;
  for (const std::uint8_t slot : session.slots) {
    const bool pushed = welcome.slots.try_push({slot, room.guests[slot].generation});
    DANCE_ASSERT(pushed);
  }
  std::array<std::uint8_t, wire::kMaxHello> out;
  const std::size_t size = wire::build(welcome, out);
  DANCE_ASSERT(size > 0);
  server_.send(session.peer, {out.data(), size});
}

std::size_t ServerAdmission::open_room(const Access& access, const wire::Hello& hello,
                                       MonoTime now) {
  const auto free =
      std::find_if(server_.rooms.begin(), server_.rooms.end(), [](auto& r) { return !r.in_use; });
  DANCE_ASSERT(free != server_.rooms.end());
  free->in_use = true;
  free->name = hello.room;
  free->opened_by = access.name;
  const auto index = static_cast<std::size_t>(free - server_.rooms.begin());
  server_.by_room.emplace(free->name, index);
  free->codec = hello.codecs[0];
  free->roster_version = 1;
  free->roster_changed = false;
  // From a random start, so that a slot's generation after a restart is not an earlier one.
  free->next_generation = static_cast<std::uint16_t>(random_());
  free->members.clear();
  free->guest_count = free->remote_count = 0;
  for (RetainedState& state : free->states) state.version = 0;
  free->has_fresh_states = free->has_first_body = free->interest_changed = false;
  free->fresh_states_due = MonoTime();
  free->host_count = free->remote_hosts = 0;
  free->settled_at = server_.cluster != nullptr ? now + kSettlesWithin : MonoTime();
  if (server_.cluster != nullptr) server_.cluster->on_room_opened(*free);
  return index;
}

std::uint64_t ServerAdmission::new_epoch() {
  for (;;)
    if (const std::uint64_t epoch = random_(); epoch != 0) return epoch;
}

// The link comes back through another sealed session: it keeps its place, its slots and their
// generations, and all else begins anew.
void ServerAdmission::move_session(std::size_t index, PeerId to) {
  ServerSession& session = server_.sessions[index];
  server_.by_peer.erase(session.peer);
  session.peer = to;
  server_.by_peer.emplace(to, index);
  session.epoch = new_epoch();
  session.stream = Stream();
  session.interest = {};
  session.pace = SessionPace();
  session.voice = SessionVoice();
  session.filters.fill(InterestFilter());
  session.knows_epoch = false;
  session.feedback_due = session.feedback_alone = MonoTime();
  std::erase(server_.bundled, index);
  std::erase(server_.reporting, index);
  std::erase(server_.speaking, index);
}

std::size_t ServerAdmission::open_session(PeerId peer, const Access& access,
                                          const wire::Hello& hello, std::size_t room) {
  const auto free = std::find_if(server_.sessions.begin(), server_.sessions.end(),
                                 [](auto& s) { return !s.in_use; });
  DANCE_ASSERT(free != server_.sessions.end());
  const auto index = static_cast<std::size_t>(free - server_.sessions.begin());
  *free = ServerSession();
  free->in_use = true;
  free->peer = peer;
  free->access = access;
  free->key_use = server_.keys.join(access, server_.limits);
  if (access.role == Role::kHost) count_hosts(server_.rooms[room], 1);
  free->token = hello.token;
  free->epoch = new_epoch();
  free->room = room;
  free->datagrams = TokenBucket(server_.limits.datagrams_per_second, server_.limits.datagram_burst);
  free->bytes = TokenBucket(server_.limits.bytes_per_second, server_.limits.byte_burst);
  server_.by_peer.emplace(peer, index);
  server_.rooms[room].members.push_back(index);
  ++server_.counters.sessions_begun;
  return index;
}

// The other servers hear whether there is a host, who alone may then change what all share.
void ServerAdmission::count_hosts(ServerRoom& room, int change) {
  const bool had_host = room.host_count > 0;
  room.host_count = static_cast<std::size_t>(static_cast<int>(room.host_count) + change);
  if (server_.cluster != nullptr && had_host != (room.host_count > 0))
    server_.cluster->on_hosts_changed(room);
}

// A key may have got another role since the last hello.
void ServerAdmission::settle_access(std::size_t index, const Access& access) {
  ServerSession& session = server_.sessions[index];
  ServerRoom& room = server_.rooms[session.room];
  const bool was_host = session.access.role == Role::kHost, is_host = access.role == Role::kHost;
  if (was_host != is_host) count_hosts(room, is_host ? 1 : -1);
  session.access = access;
}

// Makes the session's guests those of the hello, in the hello's order. Returns whether one of them
// is new to the session.
bool ServerAdmission::settle_guests(std::size_t index, const wire::Hello& hello) {
  ServerSession& session = server_.sessions[index];
  ServerRoom& room = server_.rooms[session.room];
  const auto before = session.slots;
  for (const std::uint8_t slot : before)
    if (!hello.guests.contains(room.guests[slot].id)) slots_.remove_guest(session.room, slot);
  session.slots.clear();
  bool has_new_guests = false;
  for (const GuestId& id : hello.guests) {
    const auto same = std::find_if(before.begin(), before.end(), [&](std::uint8_t slot) {
      return room.guests[slot].in_use && room.guests[slot].id == id;
    });
    if (same == before.end()) {
      bring_guest(index, id, hello.token);
      has_new_guests = true;
    } else {
      const bool pushed = session.slots.try_push(*same);
      DANCE_ASSERT(pushed);
    }
  }
  return has_new_guests;
}

void ServerAdmission::bring_guest(std::size_t index, const GuestId& id, std::uint64_t link_token) {
  const std::size_t room_index = server_.sessions[index].room;
  ServerRoom& room = server_.rooms[room_index];
  const OwnerKey key = owner_key_of(server_.sessions[index].access);
  const auto there = ServerSlots::find(room, id);
  if (there && room.guests[*there].link_token == link_token) {
    slots_.move_guest(room, *there, index);
  } else {
    if (there) {
      server_.sessions[room.guests[*there].owner].slots.erase(*there);
      slots_.remove_guest(room_index, *there);
    }
    const bool added = slots_.add_guest(index, id, link_token, key).has_value();
    DANCE_ASSERT(added);
  }
  const auto& slots = server_.sessions[index].slots;
  ServerGuest& newest = room.guests[slots[slots.size() - 1]];
  newest.key = key;  // of a guest that moved here, this server has checked it now
  if (server_.cluster != nullptr) server_.cluster->on_guest_came(room, newest);
}

std::optional<std::size_t> ServerAdmission::open_remote(std::size_t room_index, ServerId server,
                                                        MonoTime now) {
  const auto place = std::find_if(server_.remote_receivers.begin(), server_.remote_receivers.end(),
                                  [](const auto& remote) { return remote.server == 0; });
  const auto free = std::find_if(server_.sessions.begin(), server_.sessions.end(),
                                 [](auto& s) { return !s.in_use; });
  if (place == server_.remote_receivers.end() || free == server_.sessions.end())
    return std::nullopt;
  ServerRoom& room = server_.rooms[room_index];
  *place = RemoteReceivers();
  place->server = server;
  *free = ServerSession();
  free->in_use = true;
  free->room = room_index;
  free->remote = static_cast<std::size_t>(place - server_.remote_receivers.begin());
  free->epoch = new_epoch();
  free->last_heard = now;
  const auto index = static_cast<std::size_t>(free - server_.sessions.begin());
  room.members.push_back(index);
  ++room.remote_count;
  return index;
}

void ServerAdmission::drop(std::size_t index) {
  ServerSession& session = server_.sessions[index];
  ServerRoom& room = server_.rooms[session.room];
  for (const std::uint8_t slot : session.slots) slots_.remove_guest(session.room, slot);
  if (!session.is_remote() && session.access.role == Role::kHost) count_hosts(room, -1);
  if (session.is_remote())
    --room.remote_count;
  else
    server_.keys.leave(session.key_use);
  if (session.is_remote() && server_.remote_receivers[session.remote].has_host) --room.remote_hosts;
  std::erase(room.members, index);
  std::erase(server_.newcomers, index);
  std::erase(server_.bundled, index);
  std::erase(server_.reporting, index);
  std::erase(server_.speaking, index);
  server_.by_peer.erase(session.peer);
  if (session.is_remote()) server_.remote_receivers[session.remote] = RemoteReceivers();
  session.in_use = false;
  session.slots.clear();
  session.stream.bundle.clear();
  if (!room.in_use) return;
  if (room.link_count() == 0) return close_room(session.room);
  room.interest_changed = room.remote_count > 0;
  if (room.interest_changed) server_.mark_changed(room);
}

void ServerAdmission::close_room(std::size_t index) {
  ServerRoom& room = server_.rooms[index];
  server_.by_room.erase(room.name);
  room.in_use = false;  // before its other servers go, the last of which would close it again
  while (!room.members.empty()) drop(room.members.back());
  DANCE_ASSERT(room.guest_count == 0, room.guest_count);
  room.roster_changed = false;
  if (server_.cluster != nullptr) server_.cluster->on_room_closed(room);
}

}  // namespace dance

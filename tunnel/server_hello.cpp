// How links come to sessions, and sessions to their end.
#include <algorithm>

#include "core/base/assert.h"
#include "tunnel/server_core.h"

namespace dance {

std::optional<std::size_t> ServerCore::find_token(std::uint64_t token) const {
  for (std::size_t i = 0; i < sessions_.size(); ++i)
    if (sessions_[i].in_use && sessions_[i].token == token) return i;
  return std::nullopt;
}

std::optional<std::size_t> ServerCore::find_room(const wire::RoomName& name) const {
  for (std::size_t i = 0; i < rooms_.size(); ++i)
    if (rooms_[i].in_use && rooms_[i].name == name) return i;
  return std::nullopt;
}

void ServerCore::refuse(const Address& to, std::uint64_t nonce, wire::Refusal cause,
                        const GuestId& guest) {
  reject(cause == wire::Refusal::kVersion ? ServerReject::kVersion : ServerReject::kRefused);
  wire::RefusalNotice notice;
  notice.nonce = nonce;
  notice.cause = cause;
  notice.guest = guest;
  std::array<std::uint8_t, 64> out;
  send(to, {out.data(), wire::build(notice, out)});
}

void ServerCore::on_hello(const Address& from, const wire::Opening& opening, MonoTime received,
                          MonoTime now) {
  if (opening.body.size() < wire::kHelloBytes) return reject(ServerReject::kTooShort);
  if (!strangers_.take(1.0, now)) return reject(ServerReject::kStrangerRate);
  if (opening.version != wire::kWireVersion)
    return refuse(from, wire::parse_nonce(opening).value_or(0), wire::Refusal::kVersion, {});
  wire::HelloProblem problem;
  const auto hello = wire::parse_hello(opening, problem);
  if (!hello && problem.is_bad_name)
    return refuse(from, problem.nonce, wire::Refusal::kBadName, {});
  if (!hello) return reject(ServerReject::kMalformed);

  auto existing = find_token(hello->token);
  if (existing) {
    // A hello of before, or the last one from elsewhere, is a copy that somebody made.
    const ServerSession& session = sessions_[*existing];
    if (hello->link_time_us < session.hello_time_us ||
        (hello->link_time_us == session.hello_time_us && session.address != from))
      return reject(ServerReject::kOldHello);
  }
  if (existing && rooms_[sessions_[*existing].room].name != hello->room) {
    drop_session(*existing);
    existing.reset();
  }
  auto room = find_room(hello->room);
  if (const auto objection = objection_to(*hello, existing, room))
    return refuse(from, hello->nonce, objection->cause, objection->guest);

  if (!room) room = open_room(*hello);
  const std::size_t index = existing ? *existing : open_session(*hello, *room);
  ServerSession& session = sessions_[index];
  if (existing && session.address != from) {
    ++counters_.sessions_resumed;
    move_session(index, now);
  }
  if (!existing) session.unproven_since = now;
  session.address = from;
  session.last_heard = now;
  session.hello_time_us = hello->link_time_us;
  settle_guests(index, *hello);

  wire::Welcome welcome;
  welcome.nonce = hello->nonce;
  welcome.session = session.id;
  welcome.link_time_us = hello->link_time_us;
  welcome.server_receive_us = received.since_zero_us();
  welcome.server_send_us = std::max(now, received).since_zero_us();
  welcome.codec = rooms_[*room].codec;
  for (const std::uint8_t slot : session.slots) {
    const bool pushed = welcome.slots.try_push({slot, rooms_[*room].guests[slot].generation});
    DANCE_ASSERT(pushed);
  }
  std::array<std::uint8_t, wire::kHelloBytes> out;
  const std::size_t size = wire::build(welcome, out);
  DANCE_ASSERT(size > 0);
  send(from, {out.data(), size});
}

std::optional<ServerCore::Objection> ServerCore::objection_to(
    const wire::Hello& hello, std::optional<std::size_t> existing,
    std::optional<std::size_t> room) const {
  if (!room) {
    if (std::all_of(rooms_.begin(), rooms_.end(), [](const auto& r) { return r.in_use; }))
      return Objection{wire::Refusal::kServerFull, {}};
  } else if (!hello.codecs.contains(rooms_[*room].codec)) {
    return Objection{wire::Refusal::kCodec, {}};
  }
  if (!existing && by_id_.size() == sessions_.size())
    return Objection{wire::Refusal::kServerFull, {}};
  std::size_t others = 0;
  if (room) {
    for (const ServerGuest& guest : rooms_[*room].guests) {
      if (!guest.in_use || (existing && guest.owner == *existing)) continue;
      ++others;
      if (hello.guests.contains(guest.id)) return Objection{wire::Refusal::kNameTaken, guest.id};
    }
  }
  if (others + hello.guests.size() > limits_.guests_per_room)
    return Objection{wire::Refusal::kRoomFull, {}};
  return std::nullopt;
}

std::size_t ServerCore::open_room(const wire::Hello& hello) {
  const auto free = std::find_if(rooms_.begin(), rooms_.end(), [](auto& r) { return !r.in_use; });
  DANCE_ASSERT(free != rooms_.end());
  free->in_use = true;
  free->name = hello.room;
  free->codec = hello.codecs[0];
  free->roster_version = 1;
  free->roster_changed = false;
  // From a random begin, so that a slot's generation after a server's restart is not one of before.
  free->next_generation = static_cast<std::uint16_t>(random_());
  free->members.clear();
  free->guest_count = 0;
  return static_cast<std::size_t>(free - rooms_.begin());
}

std::uint64_t ServerCore::new_session_id() {
  for (;;) {
    const std::uint64_t id = random_();
    if (wire::may_be_session_id(id) && !by_id_.contains(id)) return id;
  }
}

// The session goes on at another address, under an id that only who hears there can know: whoever knew the old one
// could otherwise speak for an address that never asked for anything.
void ServerCore::move_session(std::size_t index, MonoTime now) {
  ServerSession& session = sessions_[index];
  by_id_.erase(session.id);
  session.id = new_session_id();
  by_id_.emplace(session.id, index);
  session.is_proven = false;
  session.unproven_since = now;
  session.state_acked = {};
  // What was sent, and what came, was of the old id.
  session.bundle_size = 0;
  session.sent = SentRing();
  session.held = {};
  session.received = AckWindow();
  session.feedback_due = MonoTime();
  std::erase(bundled_, index);
  std::erase(reporting_, index);
}

std::size_t ServerCore::open_session(const wire::Hello& hello, std::size_t room) {
  const auto free =
      std::find_if(sessions_.begin(), sessions_.end(), [](auto& s) { return !s.in_use; });
  DANCE_ASSERT(free != sessions_.end());
  const auto index = static_cast<std::size_t>(free - sessions_.begin());
  *free = ServerSession();
  free->in_use = true;
  free->id = new_session_id();
  free->token = hello.token;
  free->room = room;
  free->datagrams = TokenBucket(limits_.datagrams_per_second, limits_.datagram_burst);
  free->bytes = TokenBucket(limits_.bytes_per_second, limits_.byte_burst);
  by_id_.emplace(free->id, index);
  rooms_[room].members.push_back(index);
  ++counters_.sessions_begun;
  return index;
}

// Makes the session's guests those of the hello, in the hello's order.
void ServerCore::settle_guests(std::size_t index, const wire::Hello& hello) {
  ServerSession& session = sessions_[index];
  ServerRoom& room = rooms_[session.room];
  const auto before = session.slots;
  for (const std::uint8_t slot : before)
    if (!hello.guests.contains(room.guests[slot].id)) remove_guest(session.room, slot);
  session.slots.clear();
  for (const GuestId& id : hello.guests) {
    const auto kept = std::find_if(before.begin(), before.end(), [&](std::uint8_t slot) {
      return room.guests[slot].in_use && room.guests[slot].id == id;
    });
    if (kept == before.end()) {
      add_guest(index, id);
    } else {
      const bool pushed = session.slots.try_push(*kept);
      DANCE_ASSERT(pushed);
    }
  }
}

void ServerCore::add_guest(std::size_t index, const GuestId& id) {
  ServerSession& session = sessions_[index];
  ServerRoom& room = rooms_[session.room];
  const auto free =
      std::find_if(room.guests.begin(), room.guests.end(), [](auto& g) { return !g.in_use; });
  DANCE_ASSERT(free != room.guests.end());
  const auto slot = static_cast<std::uint8_t>(free - room.guests.begin());
  *free = ServerGuest();
  free->in_use = true;
  free->id = id;
  free->generation = room.next_generation++;
  free->records = TokenBucket(limits_.records_per_second, limits_.record_burst);
  free->owner = index;
  const bool pushed = session.slots.try_push(slot);
  DANCE_ASSERT(pushed);
  ++room.guest_count;
  ++room.roster_version;
  room.roster_changed = true;
}

void ServerCore::remove_guest(std::size_t room_index, std::uint8_t slot) {
  ServerRoom& room = rooms_[room_index];
  room.guests[slot].in_use = false;
  --room.guest_count;
  for (const std::size_t member : room.members) sessions_[member].state_acked[slot] = 0;
  ++room.roster_version;
  room.roster_changed = true;
}

void ServerCore::drop_session(std::size_t index) {
  ServerSession& session = sessions_[index];
  ServerRoom& room = rooms_[session.room];
  for (const std::uint8_t slot : session.slots) remove_guest(session.room, slot);
  std::erase(room.members, index);
  std::erase(bundled_, index);
  std::erase(reporting_, index);
  by_id_.erase(session.id);
  session.in_use = false;
  session.slots.clear();
  session.bundle_size = 0;
  if (room.members.empty()) {
    room.in_use = false;
    room.roster_changed = false;
  }
}

}  // namespace dance

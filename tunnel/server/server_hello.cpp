// How links come to sessions, and sessions to their end.
#include <algorithm>

#include "core/base/assert.h"
#include "tunnel/server/server_core.h"

namespace dance {
namespace {

constexpr std::uint64_t kLongestOvertaking_us = 60'000'000;

}  // namespace

// A token counts with the key that it came with: whoever learnt it gets nobody's place by it.
std::optional<std::size_t> ServerCore::find_token(std::uint64_t token, const GuestId& key) const {
  for (std::size_t i = 0; i < sessions_.size(); ++i)
    if (sessions_[i].in_use && sessions_[i].token == token && sessions_[i].access.name == key)
      return i;
  return std::nullopt;
}

std::optional<std::size_t> ServerCore::find_room(const wire::RoomName& name) const {
  for (std::size_t i = 0; i < rooms_.size(); ++i)
    if (rooms_[i].in_use && rooms_[i].name == name) return i;
  return std::nullopt;
}

void ServerCore::refuse(PeerId to, std::uint64_t nonce, wire::Refusal cause, const GuestId& guest) {
  reject(cause == wire::Refusal::kVersion ? ServerReject::kVersion : ServerReject::kRefused);
  wire::RefusalNotice notice;
  notice.nonce = nonce;
  notice.cause = cause;
  notice.guest = guest;
  std::array<std::uint8_t, 64> out;
  send(to, {out.data(), wire::build(notice, out)});
}

void ServerCore::on_hello(PeerId from, const Access& access, wire::Bytes body, MonoTime received,
                          MonoTime now) {
  const std::size_t place = std::hash<std::string_view>()(access.name.view()) % hellos_.size();
  if (!hellos_[place].take(1.0, now)) return reject(ServerReject::kSessionRate);
  wire::HelloProblem problem;
  const auto hello = wire::parse_hello(body, problem);
  if (!hello && problem.is_other_version)
    return refuse(from, problem.nonce, wire::Refusal::kVersion, {});
  if (!hello && problem.is_bad_name)
    return refuse(from, problem.nonce, wire::Refusal::kBadName, {});
  if (!hello) return reject(ServerReject::kMalformed);

  auto existing = find_token(hello->token, access.name);
  if (existing) {
    // One that was overtaken on its way, by this sealed session or the one before. Nothing is
    // overtaken by a minute: then the time of the other was wrong.
    const ServerSession& session = sessions_[*existing];
    const std::uint64_t before_us = static_cast<std::uint64_t>(session.hello_time_us) -
                                    static_cast<std::uint64_t>(hello->link_time_us);
    if ((hello->link_time_us < session.hello_time_us && before_us < kLongestOvertaking_us) ||
        (hello->link_time_us == session.hello_time_us && session.peer != from))
      return reject(ServerReject::kOldHello);
  }
  // A peer has one session: what it had under another token ends here.
  const auto own = by_peer_.find(from);
  if (own != by_peer_.end() && own->second != existing) drop_session(own->second);
  if (existing && rooms_[sessions_[*existing].room].name != hello->room) {
    drop_session(*existing);
    existing.reset();
  }
  auto room = find_room(hello->room);
  if (const auto objection = objection_to(*hello, access, existing, room))
    return refuse(from, hello->nonce, objection->cause, objection->guest);

  if (!room) room = open_room(*hello);
  const std::size_t index = existing ? *existing : open_session(from, access, *hello, *room);
  ServerSession& session = sessions_[index];
  const bool is_moved = session.peer != from;
  if (is_moved) {
    ++counters_.sessions_resumed;
    move_session(index, from);
  }
  settle_access(index, access);
  session.last_heard = now;
  session.hello_time_us = hello->link_time_us;
  settle_guests(index, *hello);
  if (!existing || is_moved) session.interest.default_divider = hello->default_divider;
  settle_interest(index, now);
  welcome(index, *hello, received, now);
  if (!existing || is_moved) {
    if (!is_newcomer(index)) newcomers_.push_back(index);
    want_key_frames_for(index, now);
  }
}

void ServerCore::welcome(std::size_t index, const wire::Hello& hello, MonoTime received,
                         MonoTime now) {
  const ServerSession& session = sessions_[index];
  const ServerRoom& room = rooms_[session.room];
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
  send(session.peer, {out.data(), size});
}

std::optional<ServerCore::Objection> ServerCore::objection_to(
    const wire::Hello& hello, const Access& access, std::optional<std::size_t> existing,
    std::optional<std::size_t> room) const {
  if (!access.may_enter(hello.room)) return Objection{wire::Refusal::kNotAllowedRoom, {}};
  if (!hello.guests.empty() && !may_have_guests(access))
    return Objection{wire::Refusal::kOnlyListens, {}};
  for (const GuestId& guest : hello.guests) {
    const bool is_others =
        access.any_name && access.role != Role::kHost && is_reserved_ && is_reserved_(guest);
    if (is_others || !access.may_bear(guest))
      return Objection{wire::Refusal::kNotAllowedName, guest};
  }
  if (!room) {
    if (std::all_of(rooms_.begin(), rooms_.end(), [](const auto& r) { return r.in_use; }))
      return Objection{wire::Refusal::kServerFull, {}};
  } else if (!hello.codecs.contains(rooms_[*room].codec)) {
    return Objection{wire::Refusal::kCodec, {}};
  }
  if (!existing && by_peer_.size() == sessions_.size())
    return Objection{wire::Refusal::kServerFull, {}};
  std::size_t others = 0;
  if (room && hello.guests.empty()) {
    const auto& members = rooms_[*room].members;
    const auto listeners = std::count_if(members.begin(), members.end(), [&](std::size_t member) {
      return member != existing && sessions_[member].slots.empty();
    });
    if (static_cast<std::size_t>(listeners) >= limits_.listeners_per_room)
      return Objection{wire::Refusal::kListenersFull, {}};
  }
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
  for (RetainedState& state : free->states) state.version = 0;
  free->has_fresh_states = free->has_first_body = false;
  free->fresh_states_due = MonoTime();
  free->host_count = 0;
  return static_cast<std::size_t>(free - rooms_.begin());
}

std::uint64_t ServerCore::new_epoch() {
  for (;;)
    if (const std::uint64_t epoch = random_(); epoch != 0) return epoch;
}

// The link comes back through another sealed session: it keeps its place, its slots and their
// generations, and all else begins anew.
void ServerCore::move_session(std::size_t index, PeerId to) {
  ServerSession& session = sessions_[index];
  by_peer_.erase(session.peer);
  session.peer = to;
  by_peer_.emplace(to, index);
  session.epoch = new_epoch();
  session.stream = Stream();
  session.interest = {};
  session.filters.fill(InterestFilter());
  session.knows_epoch = false;
  session.feedback_due = session.feedback_alone = MonoTime();
  std::erase(bundled_, index);
  std::erase(reporting_, index);
}

std::size_t ServerCore::open_session(PeerId peer, const Access& access, const wire::Hello& hello,
                                     std::size_t room) {
  const auto free =
      std::find_if(sessions_.begin(), sessions_.end(), [](auto& s) { return !s.in_use; });
  DANCE_ASSERT(free != sessions_.end());
  const auto index = static_cast<std::size_t>(free - sessions_.begin());
  *free = ServerSession();
  free->in_use = true;
  free->peer = peer;
  free->access = access;
  if (access.role == Role::kHost) ++rooms_[room].host_count;
  free->token = hello.token;
  free->epoch = new_epoch();
  free->room = room;
  free->datagrams = TokenBucket(limits_.datagrams_per_second, limits_.datagram_burst);
  free->bytes = TokenBucket(limits_.bytes_per_second, limits_.byte_burst);
  by_peer_.emplace(peer, index);
  rooms_[room].members.push_back(index);
  ++counters_.sessions_begun;
  return index;
}

// A key may have got another role since the last hello.
void ServerCore::settle_access(std::size_t index, const Access& access) {
  ServerSession& session = sessions_[index];
  ServerRoom& room = rooms_[session.room];
  if (session.access.role == Role::kHost) --room.host_count;
  if (access.role == Role::kHost) ++room.host_count;
  session.access = access;
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
  free->state_changes = TokenBucket(limits_.state_changes_per_second, limits_.state_change_burst);
  free->channel_records =
      TokenBucket(limits_.channel_records_per_second, limits_.channel_record_burst);
  free->channel_bytes = TokenBucket(limits_.channel_bytes_per_second, limits_.channel_byte_burst);
  free->owner = index;
  const bool pushed = session.slots.try_push(slot);
  DANCE_ASSERT(pushed);
  for (const std::size_t member : room.members)
    sessions_[member].filters[slot] = InterestFilter(sessions_[member].interest.default_divider);
  ++room.guest_count;
  ++room.roster_version;
  room.roster_changed = true;
  stir(room);
}

void ServerCore::remove_guest(std::size_t room_index, std::uint8_t slot) {
  ServerRoom& room = rooms_[room_index];
  room.guests[slot].in_use = false;
  --room.guest_count;
  for (const std::size_t member : room.members) sessions_[member].stream.states.forget(slot);
  ++room.roster_version;
  room.roster_changed = true;
  stir(room);
}

void ServerCore::drop_session(std::size_t index) {
  ServerSession& session = sessions_[index];
  ServerRoom& room = rooms_[session.room];
  for (const std::uint8_t slot : session.slots) remove_guest(session.room, slot);
  if (session.access.role == Role::kHost) --room.host_count;
  std::erase(room.members, index);
  std::erase(newcomers_, index);
  std::erase(bundled_, index);
  std::erase(reporting_, index);
  by_peer_.erase(session.peer);
  session.in_use = false;
  session.slots.clear();
  session.stream.bundle.clear();
  if (room.members.empty()) {
    room.in_use = false;
    room.roster_changed = false;
  }
}

}  // namespace dance

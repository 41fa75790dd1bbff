#include "tunnel/cluster/cluster_node.h"

#include <algorithm>
#include <utility>

#include "core/base/assert.h"
#include "core/base/sequence.h"

namespace dance {
namespace {

constexpr Duration kHeartbeatPeriod = Duration::ms(200);
// What stands: values that nobody writes again go after days, those of dead servers too.
constexpr Duration kWritesAgain = Duration::s(8 * 3600);
// After a partition: what others erased meanwhile may reach the bucket only now, after what this
// one has written since.
constexpr Duration kWritesAfterHealing = Duration::s(3);
constexpr int kTimesAfterHealing = 3;
// All that are there have beaten by then; as long again, and all have heard this one, who come at
// the same moment.
constexpr Duration kListens = Duration::ms(600);

bool is_older(cluster::Bytes bytes, cluster::Bytes than) {
  const auto version_of = [](cluster::Bytes value) {
    return std::get<cluster::StateValue>(*cluster::parse_value(value)).version;
  };
  return is_newer_sequence(version_of(than), version_of(bytes));
}

}  // namespace

ClusterNode::ClusterNode(const Options& options, ClusterBus& bus)
    : options_(options), bus_(bus), peers_(options.id, options.born_us), sender_(bus) {
  DANCE_ASSERT(options.id != 0);
  bus_.set_handlers({[this](std::string_view subject, cluster::Bytes bytes, MonoTime now) {
                       on_message(subject, bytes, now);
                     },
                     [this](std::string_view key, std::optional<cluster::Bytes> value,
                            MonoTime now) { on_value(key, value, now); },
                     [this](std::string_view key, MonoTime) { on_all_read(key); },
                     [this](MonoTime now) { on_back(now); },
                     [this](MonoTime now) { on_back(now); }});
  bus_.listen(cluster::beat_subject().view());
  bus_.listen(cluster::server_subject(options_.id).view());
  pending_.reserve(ClusterPeers::kMost);
}

ClusterNode::Counters ClusterNode::counters() const {
  Counters all = counters_;
  all.messages_out = sender_.messages();
  all.bytes_out = sender_.bytes();
  return all;
}

void ClusterNode::attach(ServerCore& server) {
  server_ = &server;
  server.join(*this);
}

bool ClusterNode::is_settled(MonoTime now) const {
  if (!begun_.is_set() || now - begun_ < kListens + kListens) return false;
  return peers_.is_clock_known();
}

// --- values that last

void ClusterNode::on_value(std::string_view text, std::optional<cluster::Bytes> bytes,
                           MonoTime now) {
  now_ = now;
  ++counters_.values_in;
  const auto key = cluster::parse_key(text);
  std::optional<cluster::Value> value;
  if (bytes) value = cluster::parse_value(*bytes);
  if (!key || (bytes && !value)) {
    ++counters_.malformed;
    return;
  }
  const auto room = rooms_.find(key->room);
  if (room == rooms_.end() || server_ == nullptr) return;
  const auto* presence = value ? std::get_if<cluster::PresenceValue>(&*value) : nullptr;
  const auto* guest = value ? std::get_if<cluster::GuestValue>(&*value) : nullptr;
  const bool is_state = value && std::holds_alternative<cluster::StateValue>(*value);
  switch (key->kind) {
    case cluster::KeyKind::kPresence:
      if (!value || presence != nullptr) return take_presence(room->second, *key, presence, now);
      break;
    case cluster::KeyKind::kGuest:
      if (!value || guest != nullptr) return take_guest(room->second, *key, guest, now);
      break;
    case cluster::KeyKind::kGuestState:
    case cluster::KeyKind::kRoomState:
      if (!value || is_state) return take_state(room->second, *key, bytes);
      break;
  }
  ++counters_.malformed;
}

// What was written before this server came to the room comes before its own presence; what was
// written again meanwhile comes behind it.
void ClusterNode::on_all_read(std::string_view text) {
  const auto key = cluster::parse_key(text);
  const auto room = key ? rooms_.find(key->room) : rooms_.end();
  if (room != rooms_.end() && room->second.has_presence && server_ != nullptr)
    server_->remotes().settle(key->room);
}

void ClusterNode::take_presence(Room& room, const cluster::Key& key,
                                const cluster::PresenceValue* value, MonoTime now) {
  if (key.server == options_.id) {
    room.has_presence = value != nullptr;
    // Somebody took this one for dead.
    if (value == nullptr) put_presence(key.room);
    return;
  }
  if (value != nullptr) {
    // Its guests too, where it was taken for gone: what erased its presence erased not all of them.
    room.lacks_places |= room.present.emplace(key.server, now).second;
    server_->remotes().open(key.room, key.server, value->has_host, clock().to_session(now));
  } else {
    room.present.erase(key.server);
    server_->remotes().close(key.room, key.server);
  }
}

bool ClusterNode::is_ours(const Room& room, const GuestId& guest) const {
  const auto known = room.guests.find(guest);
  return known != room.guests.end() && known->second.server == options_.id;
}

// Of one link the server it came to last; of two that want one name, who was there before.
bool ClusterNode::is_better(const cluster::GuestValue& fresh, const cluster::GuestValue& known,
                            MonoTime now) const {
  // Who took the name found that server dead; here it may be known a little later.
  if (fresh.server != known.server && peers_.is_silent(known.server, now)) return true;
  if (fresh.link_token == known.link_token)
    return std::pair(fresh.since_us, fresh.server) >= std::pair(known.since_us, known.server);
  return std::pair(fresh.since_us, fresh.server) < std::pair(known.since_us, known.server);
}

void ClusterNode::take_guest(Room& room, const cluster::Key& key, const cluster::GuestValue* value,
                             MonoTime now) {
  const auto known = room.guests.find(key.guest);
  const bool is_known_ours = is_ours(room, key.guest);
  if (value == nullptr) {
    if (known == room.guests.end()) return;
    if (is_known_ours) return put_guest(key.room, key.guest);
    server_->remotes().remove_guest(key.room, known->second.server, key.guest);
    room.guests.erase(known);
    return;
  }
  if (value->server == options_.id && !is_known_ours)
    return;  // of an earlier run: it has left meanwhile
  if (known != room.guests.end() && !is_better(*value, known->second, now)) {
    if (is_known_ours) put_guest(key.room, key.guest);
    return;
  }
  if (known == room.guests.end() && room.guests.size() >= 4 * wire::kMaxGuestsPerRoom) return;
  room.guests.insert_or_assign(key.guest, *value);
  if (value->server == options_.id) return;
  if (value->codec != room.codec) {
    ++counters_.other_codecs;
    return;
  }
  place(key.room, key.guest, *value, now);
}

// False where the room has ended here with that: its last link here may have been that guest's.
bool ClusterNode::place(const wire::RoomName& name, const GuestId& guest,
                        const cluster::GuestValue& value, MonoTime now) {
  const bool is_placed = server_->remotes().set_guest(name, value.server, guest, value.link_token,
                                                      value.key, clock().to_session(now));
  const auto room = rooms_.find(name);
  if (room == rooms_.end()) return false;
  if (!is_placed) room->second.lacks_places = true;
  apply_states(room->second, name, guest);
  return true;
}

void ClusterNode::take_state(Room& room, const cluster::Key& key,
                             std::optional<cluster::Bytes> bytes) {
  const std::pair at{key.guest, key.place};
  const auto known = room.states.find(at);
  if (!bytes) {
    if (known != room.states.end() && is_ours(room, key.guest))
      bus_.put(cluster::text_of(key).view(), known->second);
    else
      room.states.erase(at);
    return;
  }
  if (known == room.states.end() &&
      room.states.size() >= wire::kMaxGuestsPerRoom * (wire::kGuestStates + 1))
    return;
  // Of the room's the newest holds, whatever was written last: the server that holds it writes it
  // again.
  if (!key.guest.is_set() && known != room.states.end() && is_older(*bytes, known->second)) {
    if (is_first_alive(room)) bus_.put(cluster::text_of(key).view(), known->second);
    return;
  }
  room.states[at].assign(bytes->begin(), bytes->end());
  apply_state(room, key.room, key.guest, key.place, *bytes);
}

void ClusterNode::apply_states(const Room& room, const wire::RoomName& name, const GuestId& guest) {
  for (auto it = room.states.lower_bound({guest, 0});
       it != room.states.end() && it->first.first == guest; ++it)
    apply_state(room, name, guest, it->first.second, it->second);
}

void ClusterNode::apply_state(const Room& room, const wire::RoomName& name, const GuestId& guest,
                              std::size_t place, cluster::Bytes bytes) {
  const auto value = cluster::parse_value(bytes);
  DANCE_ASSERT(value.has_value());
  const auto& said = std::get<cluster::StateValue>(*value);
  wire::State state;
  state.name = guest.is_set() ? wire::guest_state_at(place) : wire::room_state_at(place);
  state.setter = said.setter;
  state.version = said.version;
  state.payload = said.payload;
  if (guest.is_set()) {
    const auto of = room.guests.find(guest);
    if (of == room.guests.end() || of->second.link_token != said.link_token) return;
  }
  server_->remotes().on_state(name, guest, state);
}

// --- time

// Also one that left no more than a guest, as when it died while it wrote.
void ClusterNode::expect_all(const Room& room, MonoTime now) {
  for (const auto& [server, since] : room.present) peers_.expect(server, since);
  for (const auto& [guest, value] : room.guests) peers_.expect(value.server, now);
}

// Those for whom there was no place are tried again: somebody may have left.
void ClusterNode::place_all(MonoTime now) {
  std::vector<wire::RoomName> names;
  for (auto& [name, room] : rooms_)
    if (std::exchange(room.lacks_places, false)) names.push_back(name);
  for (const wire::RoomName& name : names) {
    const Room room = rooms_[name];  // it may end meanwhile
    for (const auto& [guest, value] : room.guests)
      if (value.server != options_.id && value.codec == room.codec &&
          !place(name, guest, value, now))
        break;
  }
}

void ClusterNode::forget_silent(MonoTime now) {
  for (const auto& [name, room] : rooms_) expect_all(room, now);
  for (const ServerId server : peers_.forget_silent(now)) forget(server);
}

bool ClusterNode::is_first_alive(const Room& room) const {
  return std::all_of(room.present.begin(), room.present.end(), [this](const auto& at) {
    return peers_.is_dead(at.first) || at.first > options_.id;
  });
}

// Its guests have left, for all: one of those who are left in the room says so.
void ClusterNode::forget(ServerId server) {
  for (auto& [name, room] : rooms_) {
    if (server_ != nullptr) server_->remotes().close(name, server);
    const bool was_present = room.present.erase(server) > 0;
    const bool says_so = is_first_alive(room);
    for (auto it = room.guests.begin(); it != room.guests.end();) {
      if (it->second.server != server) {
        ++it;
        continue;
      }
      if (says_so) erase({cluster::KeyKind::kGuest, name, 0, it->first, 0});
      for (std::size_t place = 0; says_so && place < wire::kGuestStates; ++place)
        if (room.states.contains({it->first, place}))
          erase({cluster::KeyKind::kGuestState, name, 0, it->first, place});
      it = room.guests.erase(it);
    }
    if (was_present && says_so) erase({cluster::KeyKind::kPresence, name, server, {}, 0});
  }
}

void ClusterNode::write_after_healing(MonoTime now) {
  writes_after_healing_ = kTimesAfterHealing - 1;
  next_writing_ = std::min(next_writing_, now + kWritesAfterHealing);
}

// What others took for gone while nothing of this server reached them stands again.
void ClusterNode::on_back(MonoTime now) {
  now_ = now;
  write_all();
}

void ClusterNode::write_all() {
  for (const auto& [name, room] : rooms_) {
    put_presence(name);
    for (const auto& [guest, value] : room.guests)
      if (value.server == options_.id) put_guest(name, guest);
    for (const auto& [at, bytes] : room.states) {
      const bool is_guests = at.first.is_set();
      const auto kind = is_guests ? cluster::KeyKind::kGuestState : cluster::KeyKind::kRoomState;
      if (is_guests ? is_ours(room, at.first) : is_first_alive(room))
        bus_.put(cluster::text_of({kind, name, 0, at.first, at.second}).view(), bytes);
    }
  }
}

MonoTime ClusterNode::tick(MonoTime now) {
  now_ = now;
  if (!begun_.is_set()) begun_ = now;
  if (now - begun_ < kListens) return begun_ + kListens;
  if (!next_beat_.is_set()) peers_.take_rank();
  if (now >= next_beat_) {
    next_beat_ = now + kHeartbeatPeriod;
    beat(false);
    forget_silent(now);
    if (server_ != nullptr) place_all(now);
    if (now >= next_writing_) {
      write_all();
      next_writing_ = now + (writes_after_healing_ > 0 ? kWritesAfterHealing : kWritesAgain);
      writes_after_healing_ = std::max(0, writes_after_healing_ - 1);
    }
  }
  peers_.advance(now);
  for (const ServerId server : peers_.ask(now))
    sender_.send(cluster::server_subject(server),
                 cluster::ClockQuestion{options_.id, now.since_zero_us()});
  return std::min(next_beat_, peers_.questions_due());
}

void ClusterNode::beat(bool is_leaving) {
  cluster::Heartbeat beat;
  beat.server = options_.id;
  beat.born_us = peers_.born_us();
  beat.is_leaving = is_leaving;
  beat.address = options_.address;
  if (server_ != nullptr) {
    beat.links = static_cast<std::uint32_t>(server_->session_count());
    beat.guests = static_cast<std::uint32_t>(server_->guest_count());
  }
  sender_.send(cluster::beat_subject(), beat);
}

// Its guests stay where they are shown until they have come back through another server, or have
// not for long.
void ClusterNode::leave() {
  beat(true);
  sender_.flush();
}

}  // namespace dance

#include "tunnel/cluster/cluster_node.h"

#include <algorithm>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr Duration kBeat = Duration::ms(200);
// Silent for so long is dead: its guests may come back through any other server.
constexpr Duration kDeath = Duration::ms(900);
// Silent for so long is dead where another server says so.
constexpr Duration kSilence = Duration::ms(450);
// Those who have not come back by then have left.
constexpr Duration kGrace = Duration::s(6);
// Until the clock is known, and from then on.
constexpr Duration kFirstQuestions = Duration::ms(20);
constexpr Duration kQuestions = Duration::ms(500);
// All that are there have beaten by then.
constexpr Duration kListens = Duration::ms(600);
constexpr std::size_t kMostPeers = 256;

}  // namespace

ClusterNode::ClusterNode(const Options& options, ClusterBus& bus) : options_(options), bus_(bus) {
  DANCE_ASSERT(options.id != 0);
  bus_.set_handlers({[this](std::string_view subject, cluster::Bytes bytes, MonoTime now) {
                       on_message(subject, bytes, now);
                     },
                     [this](std::string_view key, std::optional<cluster::Bytes> value,
                            MonoTime now) { on_value(key, value, now); },
                     [this](std::string_view key, MonoTime) { on_all_read(key); },
                     [this](MonoTime now) { on_back(now); }});
  bus_.listen(cluster::beat_subject().view());
  bus_.listen(cluster::server_subject(options_.id).view());
  pending_.reserve(kMostPeers);
}

void ClusterNode::attach(ServerCore& server) {
  server_ = &server;
  server.join(*this);
}

bool ClusterNode::is_settled(MonoTime now) const {
  if (!begun_.is_set() || now - begun_ < kListens) return false;
  return leader() == options_.id || clock_.is_measured();
}

// --- what other servers say

void ClusterNode::on_message(std::string_view subject, cluster::Bytes bytes, MonoTime now) {
  now_ = now;
  ++counters_.messages_in;
  counters_.bytes_in += bytes.size();
  const auto message = cluster::parse_message(bytes);
  if (!message) {
    ++counters_.malformed;
    return;
  }
  if (const auto* record = std::get_if<cluster::RecordMessage>(&*message)) {
    ++counters_.records_in;
    const auto of = cluster::parse_pose_subject(subject);
    if (!of) {
      ++counters_.malformed;
    } else if (server_ != nullptr && record->server != options_.id) {
      server_->remotes().on_record(of->room, record->server, of->guest, record->link_token,
                                   record->record, clock_.to_session(now));
    }
  } else if (const auto* beat = std::get_if<cluster::Beat>(&*message)) {
    take(*beat, now);
  } else if (const auto* question = std::get_if<cluster::ClockQuestion>(&*message)) {
    take(*question, now);
  } else if (const auto* answer = std::get_if<cluster::ClockAnswer>(&*message)) {
    take(*answer, now);
  } else if (const auto* feedback = std::get_if<cluster::FeedbackMessage>(&*message)) {
    take(*feedback, now);
  }
}

void ClusterNode::take(const cluster::Beat& beat, MonoTime now) {
  if (beat.server == options_.id) return;
  if (!peers_.contains(beat.server) && peers_.size() >= kMostPeers) return;
  Peer& peer = peers_[beat.server];
  peer.beat = beat;
  peer.heard = now;
  peer.is_alive = !beat.is_leaving;
  if (server_ == nullptr || beat.is_leaving) return;
  // It was taken for gone, and what it had in the rooms forgotten here: read anew.
  if (buried_.contains(beat.server)) {
    buried_.erase(beat.server);
    for (const auto& [name, room] : rooms_) bus_.watch(cluster::keys_of(name).view());
  }
  server_->remotes().note_alive(beat.server, peer.round_trip, clock_.to_session(now));
}

void ClusterNode::take(const cluster::ClockQuestion& question, MonoTime now) {
  cluster::ClockAnswer answer;
  answer.server = options_.id;
  answer.asked_us = question.asked_us;
  answer.received_us = answer.sent_us = clock_.to_session(now).since_zero_us();
  send(cluster::server_subject(question.server).view(), answer);
}

void ClusterNode::take(const cluster::ClockAnswer& answer, MonoTime now) {
  const auto peer = peers_.find(answer.server);
  const MonoTime asked = MonoTime::from_us(answer.asked_us);
  if (peer == peers_.end() || asked > now || now - asked > Duration::s(2)) return;
  peer->second.round_trip = now - asked;
  if (answer.server == followed_) clock_.add({asked, answer.received_us, answer.sent_us, now});
}

void ClusterNode::take(const cluster::FeedbackMessage& message, MonoTime now) {
  if (server_ == nullptr || message.server == options_.id) return;
  for (const cluster::FeedbackEntry& entry : message.entries)
    server_->remotes().on_feedback(message.room, message.server, entry.guest, entry.feedback,
                                   clock_.to_session(now));
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
  const auto* guest = value ? std::get_if<cluster::GuestValue>(&*value) : nullptr;
  const bool is_state = value && std::holds_alternative<cluster::StateValue>(*value);
  switch (key->kind) {
    case cluster::KeyKind::kPresence:
      return take_presence(room->second, *key, value.has_value(), now);
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

void ClusterNode::take_presence(Room& room, const cluster::Key& key, bool is_there, MonoTime now) {
  if (key.server == options_.id) {
    room.has_presence = is_there;
    // Somebody took this one for dead.
    if (!is_there)
      put({cluster::KeyKind::kPresence, key.room, options_.id, {}, 0},
          cluster::PresenceValue{options_.id});
    return;
  }
  if (is_there) {
    room.present.emplace(key.server, now);
    server_->remotes().open(key.room, key.server, clock_.to_session(now));
  } else {
    room.present.erase(key.server);
    server_->remotes().close(key.room, key.server);
  }
}

// Of one link the server it came to last; of two that want one name, who was there before.
bool ClusterNode::is_better(const cluster::GuestValue& fresh, const cluster::GuestValue& known,
                            MonoTime now) const {
  // Who took the name found that server dead; here it may be known a little later.
  if (fresh.server != known.server && is_silent(known.server, now)) return true;
  if (fresh.link_token == known.link_token)
    return std::pair(fresh.since_us, fresh.server) >= std::pair(known.since_us, known.server);
  return std::pair(fresh.since_us, fresh.server) < std::pair(known.since_us, known.server);
}

void ClusterNode::take_guest(Room& room, const cluster::Key& key, const cluster::GuestValue* value,
                             MonoTime now) {
  const auto known = room.guests.find(key.guest);
  const bool is_ours = known != room.guests.end() && known->second.server == options_.id;
  if (value == nullptr) {
    if (known == room.guests.end()) return;
    if (is_ours) return put_guest(key.room, key.guest);
    server_->remotes().remove_guest(key.room, known->second.server, key.guest);
    room.guests.erase(known);
    return;
  }
  if (value->server == options_.id && !is_ours) return;  // of before: it has left meanwhile
  if (known != room.guests.end() && !is_better(*value, known->second, now)) {
    if (is_ours) put_guest(key.room, key.guest);
    return;
  }
  if (known == room.guests.end() && room.guests.size() >= 4 * wire::kMaxGuestsPerRoom) return;
  room.guests.insert_or_assign(key.guest, *value);
  if (value->server == options_.id) return;
  if (value->codec != room.codec) {
    ++counters_.other_codecs;
    return;
  }
  server_->remotes().set_guest(key.room, value->server, key.guest, value->link_token,
                               clock_.to_session(now));
  apply_states(room, key.room, key.guest);
}

void ClusterNode::take_state(Room& room, const cluster::Key& key,
                             std::optional<cluster::Bytes> bytes) {
  const std::pair at{key.guest, key.place};
  if (!bytes) {
    const auto of = room.guests.find(key.guest);
    const bool is_ours = of != room.guests.end() && of->second.server == options_.id;
    if (const auto known = room.states.find(at); is_ours && known != room.states.end())
      bus_.put(cluster::text_of(key).view(), known->second);
    else
      room.states.erase(at);
    return;
  }
  if (!room.states.contains(at) &&
      room.states.size() >= wire::kMaxGuestsPerRoom * (wire::kGuestStates + 1))
    return;
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

// --- what this server says

void ClusterNode::on_room_opened(const ServerRoom& room) {
  rooms_[room.name].codec = room.codec;
  put({cluster::KeyKind::kPresence, room.name, options_.id, {}, 0},
      cluster::PresenceValue{options_.id});
  bus_.watch(cluster::keys_of(room.name).view());
}

void ClusterNode::on_room_closed(const ServerRoom& room) {
  const auto of = rooms_.find(room.name);
  if (of == rooms_.end()) return;
  for (const GuestId& guest : of->second.heard)
    bus_.end_listen(cluster::pose_subject(room.name, guest).view());
  bus_.end_watch(cluster::keys_of(room.name).view());
  bus_.erase(cluster::text_of({cluster::KeyKind::kPresence, room.name, options_.id, {}, 0}).view());
  // The last to leave takes along what the room had.
  const bool is_last = std::all_of(of->second.present.begin(), of->second.present.end(),
                                   [this](const auto& at) { return is_dead(at.first); });
  if (is_last)
    for (const auto& [at, bytes] : of->second.states)
      if (!at.first.is_set())
        bus_.erase(
            cluster::text_of({cluster::KeyKind::kRoomState, room.name, 0, {}, at.second}).view());
  rooms_.erase(of);
}

void ClusterNode::on_guest_came(const ServerRoom& room, const ServerGuest& guest) {
  cluster::GuestValue value;
  value.server = options_.id;
  value.link_token = guest.link_token;
  value.since_us = clock_.to_session(now_).since_zero_us();
  value.codec = room.codec;
  rooms_[room.name].guests.insert_or_assign(guest.id, value);
  put_guest(room.name, guest.id);
}

void ClusterNode::put_guest(const wire::RoomName& room, const GuestId& guest) {
  put({cluster::KeyKind::kGuest, room, 0, guest, 0}, rooms_[room].guests[guest]);
}

void ClusterNode::on_guest_left(const ServerRoom& room, const ServerGuest& guest) {
  const auto of = rooms_.find(room.name);
  if (of == rooms_.end()) return;
  const auto known = of->second.guests.find(guest.id);
  if (known == of->second.guests.end() || known->second.server != options_.id ||
      known->second.link_token != guest.link_token)
    return;
  of->second.guests.erase(known);
  bus_.erase(cluster::text_of({cluster::KeyKind::kGuest, room.name, 0, guest.id, 0}).view());
  for (std::size_t place = 0; place < guest.states.size(); ++place) {
    if (guest.states[place].version == 0) continue;
    of->second.states.erase({guest.id, place});
    bus_.erase(
        cluster::text_of({cluster::KeyKind::kGuestState, room.name, 0, guest.id, place}).view());
  }
}

// A server hears what its own links want, and no more.
void ClusterNode::on_wanted(const ServerRoom& room, const ServerGuest& guest, bool is_wanted) {
  const auto of = rooms_.find(room.name);
  if (of == rooms_.end()) return;
  const auto subject = cluster::pose_subject(room.name, guest.id);
  if (is_wanted && of->second.heard.insert(guest.id).second)
    bus_.listen(subject.view());
  else if (!is_wanted && of->second.heard.erase(guest.id) > 0)
    bus_.end_listen(subject.view());
}

void ClusterNode::on_record(const ServerRoom& room, const ServerGuest& guest,
                            const wire::Record& record) {
  ++counters_.records_out;
  send(cluster::pose_subject(room.name, guest.id).view(),
       cluster::RecordMessage{options_.id, guest.link_token, record});
}

void ClusterNode::on_state(const ServerRoom& room, const ServerGuest* guest,
                           const wire::State& state) {
  cluster::StateValue value;
  value.link_token = guest != nullptr ? guest->link_token : 0;
  value.setter = state.setter;
  value.version = state.version;
  value.payload = state.payload;
  const GuestId of = guest != nullptr ? guest->id : GuestId();
  const std::size_t place = wire::place_of(state.name);
  const std::size_t size = cluster::build(cluster::Value(value), buffer_);
  DANCE_ASSERT(size > 0);
  rooms_[room.name].states[{of, place}].assign(buffer_.begin(),
                                               buffer_.begin() + static_cast<std::ptrdiff_t>(size));
  put({guest != nullptr ? cluster::KeyKind::kGuestState : cluster::KeyKind::kRoomState, room.name,
       0, of, place},
      value);
}

void ClusterNode::on_feedback(ServerId to, const ServerRoom& room, const ServerGuest& guest,
                              const RemoteFeedback& feedback) {
  auto pending = std::find_if(pending_.begin(), pending_.end(), [&](const Pending& it) {
    return it.to == to && it.message.room == room.name;
  });
  if (pending == pending_.end()) {
    pending_.emplace_back();
    pending = pending_.end() - 1;
    pending->to = to;
    pending->message.server = options_.id;
    pending->message.room = room.name;
  }
  pending->message.path = feedback.path;
  const bool pushed = pending->message.entries.try_push({guest.id, feedback});
  DANCE_ASSERT(pushed);
  if (pending->message.entries.is_full()) flush(*pending);
}

void ClusterNode::flush(Pending& pending) {
  if (!pending.message.entries.empty())
    send(cluster::server_subject(pending.to).view(), pending.message);
  pending.message.entries.clear();
}

void ClusterNode::end_turn(MonoTime now) {
  now_ = now;
  for (Pending& pending : pending_) flush(pending);
  pending_.clear();
}

void ClusterNode::send(std::string_view subject, const cluster::Message& message) {
  const std::size_t size = cluster::build(message, buffer_);
  DANCE_ASSERT(size > 0);
  ++counters_.messages_out;
  counters_.bytes_out += size;
  bus_.publish(subject, {buffer_.data(), size});
}

void ClusterNode::put(const cluster::Key& key, const cluster::Value& value) {
  const std::size_t size = cluster::build(value, buffer_);
  DANCE_ASSERT(size > 0);
  bus_.put(cluster::text_of(key).view(), {buffer_.data(), size});
}

// --- time

bool ClusterNode::is_dead(ServerId server) const {
  if (server == options_.id) return false;
  const auto peer = peers_.find(server);
  return peer != peers_.end() && !peer->second.is_alive;
}

bool ClusterNode::is_silent(ServerId server, MonoTime now) const {
  if (server == options_.id) return false;
  const auto peer = peers_.find(server);
  return peer != peers_.end() && (!peer->second.is_alive || now - peer->second.heard > kSilence);
}

ServerId ClusterNode::leader() const {
  std::pair first{options_.born_us, options_.id};
  for (const auto& [id, peer] : peers_)
    if (peer.is_alive) first = std::min(first, std::pair(peer.beat.born_us, id));
  return first.second;
}

void ClusterNode::follow_leader(MonoTime now) {
  const ServerId first = leader();
  if (first != followed_) {
    followed_ = first;
    clock_.begin();
  }
  clock_.advance(now);
}

void ClusterNode::ask_clocks(MonoTime now) {
  const bool is_new = followed_ != options_.id && !clock_.is_measured();
  if (now < next_question_) return;
  next_question_ = now + (is_new ? kFirstQuestions : kQuestions);
  for (const auto& [id, peer] : peers_)
    if (peer.is_alive && (!is_new || id == followed_))
      send(cluster::server_subject(id).view(),
           cluster::ClockQuestion{options_.id, now.since_zero_us()});
}

// A server of before that is in the values of a room has never been heard: it counts as heard when
// it was first read of.
void ClusterNode::note_deaths(MonoTime now) {
  for (auto& [name, room] : rooms_)
    for (const auto& [server, since] : room.present)
      if (!peers_.contains(server) && peers_.size() < kMostPeers) {
        peers_[server].beat.server = server;
        peers_[server].beat.born_us = INT64_MAX;
        peers_[server].heard = since;
      }
  for (auto& [id, peer] : peers_) {
    if (!peer.is_alive || now - peer.heard <= kDeath) continue;
    peer.is_alive = false;
    ++counters_.deaths;
  }
  for (auto peer = peers_.begin(); peer != peers_.end();) {
    if (now - peer->second.heard <= kGrace) {
      ++peer;
      continue;
    }
    bury(peer->first);
    if (buried_.is_full()) buried_.erase_at(0);
    const bool pushed = buried_.try_push(peer->first);
    DANCE_ASSERT(pushed);
    peer = peers_.erase(peer);
  }
}

bool ClusterNode::is_first_alive(const Room& room) const {
  return std::all_of(room.present.begin(), room.present.end(), [this](const auto& at) {
    return is_dead(at.first) || at.first > options_.id;
  });
}

// Its guests have left, for all: one of those who are left in the room says so.
void ClusterNode::bury(ServerId server) {
  for (auto& [name, room] : rooms_) {
    if (server_ != nullptr) server_->remotes().close(name, server);
    const bool says_so = is_first_alive(room);
    for (auto it = room.guests.begin(); it != room.guests.end();) {
      if (it->second.server != server) {
        ++it;
        continue;
      }
      if (says_so)
        bus_.erase(cluster::text_of({cluster::KeyKind::kGuest, name, 0, it->first, 0}).view());
      for (std::size_t place = 0; says_so && place < wire::kGuestStates; ++place)
        if (room.states.contains({it->first, place}))
          bus_.erase(
              cluster::text_of({cluster::KeyKind::kGuestState, name, 0, it->first, place}).view());
      it = room.guests.erase(it);
    }
    if (room.present.erase(server) > 0 && says_so)
      bus_.erase(cluster::text_of({cluster::KeyKind::kPresence, name, server, {}, 0}).view());
  }
}

// What others took for gone while nothing of this server reached them stands again.
void ClusterNode::on_back(MonoTime now) {
  now_ = now;
  for (const auto& [name, room] : rooms_) {
    put({cluster::KeyKind::kPresence, name, options_.id, {}, 0},
        cluster::PresenceValue{options_.id});
    for (const auto& [guest, value] : room.guests)
      if (value.server == options_.id) put_guest(name, guest);
    for (const auto& [at, bytes] : room.states) {
      const auto of = room.guests.find(at.first);
      if (of != room.guests.end() && of->second.server == options_.id)
        bus_.put(
            cluster::text_of({cluster::KeyKind::kGuestState, name, 0, at.first, at.second}).view(),
            bytes);
    }
  }
}

MonoTime ClusterNode::tick(MonoTime now) {
  now_ = now;
  if (!begun_.is_set()) begun_ = now;
  if (now >= next_beat_) {
    next_beat_ = now + kBeat;
    beat(false);
    note_deaths(now);
  }
  follow_leader(now);
  ask_clocks(now);
  return std::min(next_beat_, next_question_);
}

wire::ServerList ClusterNode::other_servers() const {
  wire::ServerList servers;
  for (const auto& [id, peer] : peers_)
    if (peer.is_alive && peer.beat.address.is_set() && !servers.try_push(peer.beat.address)) break;
  return servers;
}

void ClusterNode::beat(bool is_leaving) {
  cluster::Beat beat;
  beat.server = options_.id;
  beat.born_us = options_.born_us;
  beat.is_leaving = is_leaving;
  beat.address = options_.address;
  if (server_ != nullptr) {
    beat.links = static_cast<std::uint32_t>(server_->session_count());
    beat.guests = static_cast<std::uint32_t>(server_->guest_count());
  }
  send(cluster::beat_subject().view(), beat);
}

// Its guests stay where they are shown until they have come back through another server, or have
// not for long.
void ClusterNode::leave() { beat(true); }

}  // namespace dance

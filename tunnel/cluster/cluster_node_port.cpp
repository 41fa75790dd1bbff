// What the server's state machine tells, and what goes out of it.
#include <algorithm>

#include "core/base/assert.h"
#include "tunnel/cluster/cluster_node.h"

namespace dance {

void ClusterNode::on_room_opened(const ServerRoom& room) {
  Room& opened = rooms_[room.name];
  opened = Room();
  opened.codec = room.codec;
  put_presence(room.name);
  bus_.watch(cluster::keys_of(room.name).view());
}

void ClusterNode::on_hosts_changed(const ServerRoom& room) {
  const auto of = rooms_.find(room.name);
  if (of == rooms_.end()) return;
  of->second.has_host = room.host_count > 0;
  put_presence(room.name);
}

void ClusterNode::put_presence(const wire::RoomName& room) {
  put({cluster::KeyKind::kPresence, room, options_.id, {}, 0},
      cluster::PresenceValue{options_.id, rooms_[room].has_host});
}

void ClusterNode::on_room_closed(const ServerRoom& room) {
  const auto of = rooms_.find(room.name);
  if (of == rooms_.end()) return;
  for (const GuestId& guest : of->second.subscribed)
    for (const cluster::Text& subject : cluster::subjects_of(room.name, guest))
      bus_.end_listen(subject.view());
  bus_.end_watch(cluster::keys_of(room.name).view());
  erase({cluster::KeyKind::kPresence, room.name, options_.id, {}, 0});
  // The last to leave takes along what the room had.
  const bool is_last = std::all_of(of->second.present.begin(), of->second.present.end(),
                                   [this](const auto& at) { return peers_.is_dead(at.first); });
  if (is_last)
    for (const auto& [at, bytes] : of->second.states)
      if (!at.first.is_set()) erase({cluster::KeyKind::kRoomState, room.name, 0, {}, at.second});
  rooms_.erase(of);
}

void ClusterNode::on_guest_came(const ServerRoom& room, const ServerGuest& guest) {
  cluster::GuestValue value;
  value.server = options_.id;
  value.link_token = guest.link_token;
  value.key = guest.key;
  value.since_us = clock().to_session(now_).since_zero_us();
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
  erase({cluster::KeyKind::kGuest, room.name, 0, guest.id, 0});
  for (std::size_t place = 0; place < guest.states.size(); ++place) {
    if (guest.states[place].version == 0) continue;
    of->second.states.erase({guest.id, place});
    erase({cluster::KeyKind::kGuestState, room.name, 0, guest.id, place});
  }
}

// A server hears what its own links want, and no more.
void ClusterNode::on_wanted(const ServerRoom& room, const ServerGuest& guest, bool is_wanted) {
  const auto of = rooms_.find(room.name);
  if (of == rooms_.end()) return;
  const bool is_news = is_wanted ? of->second.subscribed.insert(guest.id).second
                                 : of->second.subscribed.erase(guest.id) > 0;
  if (!is_news) return;
  for (const cluster::Text& subject : cluster::subjects_of(room.name, guest.id))
    if (is_wanted)
      bus_.listen(subject.view());
    else
      bus_.end_listen(subject.view());
}

void ClusterNode::on_record(const ServerRoom& room, const ServerGuest& guest,
                            const wire::Record& record) {
  ++counters_.records_out;
  sender_.send(cluster::pose_subject(room.name, guest.id),
               cluster::RecordMessage{options_.id, guest.link_token, record});
}

void ClusterNode::on_voice(const ServerRoom& room, const ServerGuest& guest,
                           const wire::VoiceRecord& record) {
  ++counters_.voices_out;
  sender_.send(cluster::voice_subject(room.name, guest.id),
               cluster::VoiceMessage{options_.id, guest.link_token, record});
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

void ClusterNode::on_file(ServerId to, const ServerRoom& room, const ServerGuest& guest,
                          const FilePart& part) {
  sender_.send(cluster::server_subject(to),
               cluster::FileMessage{options_.id, room.name, guest.id, part});
}

void ClusterNode::on_removal(const wire::RoomName& room, const RemovalNotice& notice) {
  sender_.send(cluster::beat_subject(), cluster::RemovalMessage{options_.id, room, notice});
}

void ClusterNode::flush(Pending& pending) {
  if (!pending.message.entries.empty())
    sender_.send(cluster::server_subject(pending.to), pending.message);
  pending.message.entries.clear();
}

void ClusterNode::end_turn(MonoTime now) {
  now_ = now;
  // One server's after the other, whatever room they are about.
  for (std::size_t i = 0; i < pending_.size(); ++i)
    for (std::size_t k = i; k < pending_.size(); ++k)
      if (pending_[k].to == pending_[i].to) flush(pending_[k]);
  pending_.clear();
  sender_.flush();
  bus_.end_turn(now);
}

void ClusterNode::put(const cluster::Key& key, const cluster::Value& value) {
  const std::size_t size = cluster::build(value, buffer_);
  DANCE_ASSERT(size > 0);
  bus_.put(cluster::text_of(key).view(), {buffer_.data(), size});
}

void ClusterNode::erase(const cluster::Key& key) { bus_.erase(cluster::text_of(key).view()); }

}  // namespace dance

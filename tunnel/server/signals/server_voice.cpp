#include "tunnel/server/signals/server_voice.h"

#include "core/base/deadline.h"

namespace dance {
namespace {

// Beyond it nobody plays it; clocks are mapped better than this.
constexpr std::int64_t kOldestVoice_us = 5'000'000;
constexpr std::int64_t kFarthestVoice_us = 1'000'000;
// What waits for its share of a line is looked at again.
constexpr Duration kVoiceRetry = Duration::ms(5);

bool is_timely(const wire::VoiceRecord& record, MonoTime now) {
  const std::int64_t ahead_us = record.capture_us - now.since_zero_us();
  return ahead_us >= -kOldestVoice_us && ahead_us <= kFarthestVoice_us;
}

}  // namespace

void ServerVoice::on_voices(std::size_t index, wire::Bytes body, MonoTime received, MonoTime now) {
  ServerSession& session = server_.sessions[index];
  const std::int64_t now_us = received.since_zero_us();
  if (!wire::are_voices(now_us, body)) return server_.reject(ServerReject::kMalformed);
  // As with poses: until the welcome has come, slots are those of the session before.
  if (!session.knows_epoch) return server_.reject(ServerReject::kLate);
  if (!may_send_records(session.access)) return server_.reject(ServerReject::kNotAllowed);
  for (ByteReader in(body); in.remaining() > 0;)
    on_voice(index, *wire::parse_voice(now_us, in), received, now);
}

void ServerVoice::on_voice(std::size_t session, const wire::VoiceRecord& record, MonoTime received,
                           MonoTime now) {
  ServerGuest* guest = server_.guest_of(session, record.slot.slot);
  if (guest == nullptr || guest->generation != record.slot.generation)
    return server_.reject(ServerReject::kForeignSlot);
  if (!is_timely(record, received)) return server_.reject(ServerReject::kBadTime);
  if (!guest->voice.packets.take(1.0, now) ||
      !guest->voice.bytes.take(static_cast<double>(record.packet.size()), now))
    return server_.reject(ServerReject::kVoiceRate);
  take(session, *guest, record, now);
}

void ServerVoice::on_remote_voice(std::size_t session, const wire::VoiceRecord& record,
                                  MonoTime now) {
  ServerGuest* guest = server_.guest_of(session, record.slot.slot);
  if (guest == nullptr) return server_.reject(ServerReject::kForeignSlot);
  if (!is_timely(record, now)) return server_.reject(ServerReject::kBadTime);
  wire::VoiceRecord here = record;
  here.slot.generation = guest->generation;
  take(session, *guest, here, now);
}

void ServerVoice::take(std::size_t from, ServerGuest& guest, const wire::VoiceRecord& record,
                       MonoTime now) {
  ++server_.counters.voices_in;
  ++guest.voice.packets_in;
  guest.voice.bytes_in += record.packet.size();
  const ServerRoom& room = server_.rooms[server_.sessions[from].room];
  if (room.remote_count > 0 && !server_.sessions[from].is_remote())
    server_.cluster->on_voice(room, guest, record);
  for (const std::size_t member : room.members)
    if (member != from && wants(server_.sessions[member], member, record.slot.slot))
      offer(member, record, now);
}

bool ServerVoice::wants(const ServerSession& receiver, std::size_t index, std::uint8_t slot) const {
  return !receiver.is_remote() && !receiver.voice.muted.test(slot) &&
         receiver.filters[slot].wants_any() && !server_.is_newcomer(index);
}

void ServerVoice::offer(std::size_t index, const wire::VoiceRecord& record, MonoTime now) {
  ServerSession& to = server_.sessions[index];
  SessionVoice& voice = to.voice;
  const ServerRoom& room = server_.rooms[to.room];
  const ServerGuest& guest = room.guests[record.slot.slot];
  const std::size_t place =
      voice.places.take(record.slot.slot, guest.key, guest.link_token, voice.share.voices(), now);
  if (place == kMaxTalkers) {
    ++server_.counters.voices_crowded;
    return;
  }
  voice.share.note_wanted(record.packet.size());
  if (place >= voice.share.voices()) {
    ++server_.counters.voices_held_back;
    return;
  }
  if (voice.queue.push(record, now)) ++server_.counters.voices_held_back;
  if (voice.due.is_set()) return;
  voice.due = now + server_.limits.share_window.value_or(to.pace.window);
  server_.speaking.push_back(index);
}

void ServerVoice::send(ServerSession& to, wire::Bytes datagram) {
  to.voice.bytes_out += datagram.size() + wire::kSealOverhead + kIpUdp_bytes;
  server_.counters.voice_bytes_out += datagram.size() + wire::kSealOverhead;
  server_.send(to.peer, datagram);
}

// True when nothing waits any more.
bool ServerVoice::flush(std::size_t index, MonoTime now) {
  ServerSession& to = server_.sessions[index];
  VoiceQueue& queue = to.voice.queue;
  server_.counters.voices_held_back += queue.drop_late(now);
  std::array<std::uint8_t, wire::kMaxPlain> bytes;
  ByteWriter out(bytes);
  for (; !queue.is_empty(); queue.pop()) {
    const wire::VoiceRecord record = queue.front();
    const std::size_t size = wire::kVoiceRecordHeader + record.packet.size();
    if (out.size() > 0 && out.size() + size > bytes.size()) {
      send(to, out.written());
      out = ByteWriter(bytes);
    }
    const std::size_t more = out.size() > 0 ? size : VoiceShare::cost_of(record.packet.size());
    if (!to.voice.share.take(more, now)) break;
    if (out.size() == 0) wire::begin_voices(out);
    wire::add_voice(record, out);
    ++to.voice.packets_out;
    ++server_.counters.voices_out;
  }
  if (out.size() > 0) send(to, out.written());
  to.voice.due = queue.is_empty() ? MonoTime() : now + kVoiceRetry;
  return queue.is_empty();
}

void ServerVoice::send_due(MonoTime now) {
  std::erase_if(server_.speaking, [&](std::size_t index) {
    return server_.sessions[index].voice.due <= now && flush(index, now);
  });
}

MonoTime ServerVoice::next_deadline() const {
  MonoTime next;
  for (const std::size_t index : server_.speaking)
    next = earlier(next, server_.sessions[index].voice.due);
  return next;
}

}  // namespace dance

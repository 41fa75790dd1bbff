#include "tunnel/server/signals/server_forwarder.h"

#include <algorithm>
#include <cstring>

#include "core/base/assert.h"
#include "core/base/sequence.h"

namespace dance {
namespace {

// A capture further from now than this is no capture of a dance under way.
constexpr std::int64_t kLongestAge_us = 60'000'000;
// Nothing is captured in the future; clocks are mapped better than this.
constexpr std::int64_t kFarthestAhead_us = 1'000'000;
// Loss, round trip and the number of guests; then each of them.
constexpr std::size_t kFeedbackHead = 2 + 2 + 2 + 1;
constexpr std::size_t kFeedbackGuest = 7 + 1 + 4;
// Of a pose's record, about: kind, slot, low bits of its numbers, time since the one before.
constexpr std::size_t kRecordHead = 6;
// Whose poses come more often shows up without the retained one.
constexpr Duration kStillMoves = Duration::ms(150);

}  // namespace

void ServerForwarder::on_records(std::size_t index, wire::Bytes body, MonoTime received,
                                 MonoTime now) {
  ByteReader in(body);
  const auto header = wire::parse_records_header(in);
  // What receivers have is the server's to say.
  if (!header || header->has_feedback) return server_.reject(ServerReject::kMalformed);
  // All of a datagram or nothing: half of a damaged one is not worth more than none.
  const wire::RecordChain begin{received.since_zero_us()};
  ByteReader check = in;
  for (wire::RecordChain chain = begin; check.remaining() > 0;)
    if (!wire::parse_record(chain, check)) return server_.reject(ServerReject::kMalformed);
  // Until the welcome has come a link dances on in the session before: other slots, other numbers.
  if (!server_.sessions[index].knows_epoch) return server_.reject(ServerReject::kLate);
  server_.sessions[index].stream.received.note(header->number);
  if (header->has_acks) feedback_.on_acks(index, header->acks, now);
  for (const std::uint8_t slot : header->wants) feedback_.on_want(index, slot, now);
  if (header->has_records && !may_send_records(server_.sessions[index].access))
    return server_.reject(ServerReject::kNotAllowed);
  for (wire::RecordChain chain = begin; in.remaining() > 0;)
    on_record(index, *wire::parse_record(chain, in), received, now);
}

bool ServerForwarder::is_timely(const wire::Record& record, MonoTime received) {
  const std::int64_t received_us = received.since_zero_us();
  if (record.capture_us >= received_us - kLongestAge_us &&
      record.capture_us <= received_us + kFarthestAhead_us)
    return true;
  server_.reject(ServerReject::kBadTime);
  return false;
}

void ServerForwarder::on_record(std::size_t session, wire::Record record, MonoTime received,
                                MonoTime now) {
  if (record.kind == wire::RecordKind::kChannel)
    return on_channel_record(session, std::move(record), now);
  ServerGuest* guest = server_.guest_of(session, record.slot);
  if (guest == nullptr) return server_.reject(ServerReject::kForeignSlot);
  if (!is_timely(record, received)) return;
  if (!guest->records.take(1.0, now)) return server_.reject(ServerReject::kGuestRate);
  const StreamGate& gate = record.kind == wire::RecordKind::kPose ? guest->poses : guest->hands;
  // The link need not know the generation.
  record.stream &= 0xffff;
  const bool is_narrow = record.is_narrow;
  if (!wire::widen(0, gate.has_any(), gate.stream(), gate.newest(), record) ||
      (is_narrow && gate.contradicts(record.sequence, record.capture_us)))
    return server_.reject(ServerReject::kLate);
  if (record.sent_age_us != wire::kNoAge)
    record.server_age_us = static_cast<std::int32_t>(received.since_zero_us() - record.capture_us);
  take(session, *guest, record, received, now);
}

void ServerForwarder::on_remote_record(std::size_t session, wire::Record record, MonoTime now) {
  ServerGuest* guest = server_.guest_of(session, record.slot);
  if (guest == nullptr) return server_.reject(ServerReject::kForeignSlot);
  ++server_.remote_receivers[server_.sessions[session].remote].meter.records_in;
  if (record.kind == wire::RecordKind::kChannel)
    return take_channel(session, *guest, std::move(record), now);
  if (is_timely(record, now)) take(session, *guest, record, now, now);
}

// The newest wins; its stream is that of the link here, its guest's generation comes to it.
void ServerForwarder::take(std::size_t session, ServerGuest& guest, const wire::Record& told,
                           MonoTime received, MonoTime now) {
  wire::Record record = told;
  const bool is_pose = record.kind == wire::RecordKind::kPose;
  record.stream = std::uint32_t{guest.generation} << 16 | (record.stream & 0xffff);
  switch ((is_pose ? guest.poses : guest.hands)
              .judge(record.stream, record.sequence, record.capture_us)) {
    case StreamGate::Verdict::kNewest:
    case StreamGate::Verdict::kNewStream:
      break;
    case StreamGate::Verdict::kDuplicate:
      return server_.reject(ServerReject::kDuplicate);
    case StreamGate::Verdict::kLate:
    case StreamGate::Verdict::kOldStream:
      return server_.reject(ServerReject::kLate);
  }
  ++server_.counters.records_in;
  if (is_pose) guest.jitter.add(record.capture_us, received.since_zero_us());
  if (is_pose) guest.flow.add(record.payload.size() + kRecordHead);
  if (record.is_base) ++guest.base_count;
  if (!is_pose) ++guest.hands_count;
  if (is_pose) guest.last_pose = now;
  if (is_pose && record.is_intra) retain(guest, record);
  forward(session, record, now);
  if (is_pose) guest.previous.keep(record);
}

// Limited by itself, so that channels take nothing from poses, and none delays or drops another's.
void ServerForwarder::on_channel_record(std::size_t session, wire::Record record, MonoTime now) {
  ServerGuest* guest = server_.guest_of(session, record.slot);
  if (guest == nullptr) return server_.reject(ServerReject::kForeignSlot);
  if (!guest->channel_records.take(1.0, now) ||
      !guest->channel_bytes.take(static_cast<double>(record.payload.size()), now))
    return server_.reject(ServerReject::kChannelRate);
  take_channel(session, *guest, std::move(record), now);
}

void ServerForwarder::take_channel(std::size_t session, ServerGuest& guest, wire::Record record,
                                   MonoTime now) {
  ChannelGate& gate = guest.channels[record.channel];
  if (gate.has_any && !is_newer_sequence(record.sequence, gate.sequence))
    return server_.reject(ServerReject::kLate);
  gate = {true, record.sequence};
  record.stream = std::uint32_t{guest.generation} << 16;
  ++server_.counters.records_in;
  forward(session, record, now);
}

void ServerForwarder::forward(std::size_t from, const wire::Record& record, MonoTime now) {
  ServerRoom& room = server_.rooms[server_.sessions[from].room];
  // Once for each guest: without the proportions nobody could decode the pose.
  if (room.has_first_body) states_.send_fresh(room, now);
  const bool is_remote = server_.sessions[from].is_remote();
  if (room.remote_count > 0 && !is_remote)
    server_.cluster->on_record(room, room.guests[record.slot], record);
  for (const std::size_t member : room.members) {
    if (server_.sessions[member].is_remote()) {
      if (!is_remote) ++server_.remote_receivers[server_.sessions[member].remote].meter.records_out;
      continue;
    }
    if (member == from || !interest_.take(member, record, now)) continue;
    if (record.kind == wire::RecordKind::kPose)
      repeat_before(member, room.guests[record.slot], record, now);
    add(member, record, now);
  }
}

// The pose before goes once more, in front of this one, to whom it may be lost. Who gets only some
// poses gets intra frames, or few others: there it would be of no use.
void ServerForwarder::repeat_before(std::size_t member, const ServerGuest& guest,
                                    const wire::Record& next, MonoTime now) {
  ServerSession& to = server_.sessions[member];
  if (!to.repeats_down.is_on() || to.filters[next.slot].divider() != 1 ||
      !guest.previous.is_before(next))
    return;
  put(member, guest.previous.again(), now);
  ++server_.counters.records_repeated;
}

void ServerForwarder::add(std::size_t index, const wire::Record& record, MonoTime now) {
  put(index, record, now);
  ServerSession& to = server_.sessions[index];
  if (record.kind == wire::RecordKind::kPose) {
    to.stream.sent.add({record.stream, static_cast<std::uint16_t>(record.sequence), record.slot});
    to.stream.bundle.count_pose();
  }
  ++server_.counters.records_out;
}

void ServerForwarder::put(std::size_t index, const wire::Record& record, MonoTime now) {
  ServerSession& to = server_.sessions[index];
  RecordBundler& bundle = to.stream.bundle;
  if (!bundle.has_room_for(record)) flush_bundle(index, now);
  if (bundle.is_empty()) server_.bundled.push_back(index);
  wire::Record told = record;
  told.is_intra = told.is_base = false;  // the receiver sees it
  to.filters[record.slot].tell_left_out(told);
  bundle.add(told, is_narrow_for(to.filters[record.slot].frames(), record), now.since_zero_us(),
             now + server_.limits.share_window.value_or(to.pace.window));
}

// Who wants less than all of everybody waits: what comes next is not known.
bool ServerForwarder::is_bundle_due(const ServerSession& session, MonoTime now) const {
  return session.stream.bundle.is_due(now,
                                      session.full_shares > 0 ? session.full_shares : SIZE_MAX);
}

void ServerForwarder::flush_bundle(std::size_t index, MonoTime now) {
  if (!server_.sessions[index].stream.bundle.is_empty()) send_records(index, now);
  std::erase(server_.bundled, index);
}

// The bundle, if there is one, and the feedback, if it is due.
void ServerForwarder::send_records(std::size_t index, MonoTime now) {
  ServerSession& session = server_.sessions[index];
  Stream& stream = session.stream;
  wire::RecordsHeader header;
  if (session.feedback_due.is_set() && session.feedback_due <= now &&
      stream.bundle.room() >= kFeedbackHead + kFeedbackGuest * session.slots.size()) {
    // Links count what the server has of them; rarely is enough.
    const bool is_repeat = session.feedback_is_repeat;
    header.has_feedback = feedback_.fill(index, now, header.feedback);
    if (header.has_feedback && is_repeat) stream.received.fill(header);
  }
  if (stream.bundle.is_empty() && !header.has_feedback) return;
  std::array<std::uint8_t, wire::kMaxPlain> bytes;
  server_.send(session.peer, stream.write(header, true, bytes));
}

void ServerForwarder::flush_due(MonoTime now) {
  // Who has waited longest comes first, and leaves the list.
  for (std::size_t i = 0; i < server_.bundled.size();) {
    if (is_bundle_due(server_.sessions[server_.bundled[i]], now) &&
        !server_.is_newcomer(server_.bundled[i]))
      flush_bundle(server_.bundled[i], now);
    else
      ++i;
  }
  // Backwards, as who is done leaves this one too.
  for (std::size_t i = server_.reporting.size(); i-- > 0;) {
    const ServerSession& session = server_.sessions[server_.reporting[i]];
    if (session.is_remote()) {
      if (session.feedback_due <= now) feedback_.tell_remote(server_.reporting[i], now);
      continue;
    }
    // With a bundle under way it goes along.
    if (session.feedback_alone <= now && session.stream.bundle.is_empty() &&
        !server_.is_newcomer(server_.reporting[i]))
      send_records(server_.reporting[i], now);
  }
}

void ServerForwarder::retain(ServerGuest& guest, const wire::Record& record) {
  guest.retained.is_set = true;
  guest.retained.record = record;
  guest.retained.record.payload = {};
  guest.retained.record.is_retained = true;
  guest.retained.size = record.payload.size();
  std::memcpy(guest.retained.payload.data(), record.payload.data(), record.payload.size());
}

void ServerForwarder::send_retained(std::size_t to, std::uint8_t slot, MonoTime now) {
  const ServerGuest& guest = server_.rooms[server_.sessions[to].room].guests[slot];
  if (!guest.in_use || guest.owner == to || !guest.retained.is_set ||
      !server_.sessions[to].filters[slot].wants_any())
    return;
  wire::Record record = guest.retained.record;
  record.payload = {guest.retained.payload.data(), guest.retained.size};
  add(to, record, now);
}

void ServerForwarder::repeat_retained(std::size_t to, MonoTime now) {
  const ServerSession& session = server_.sessions[to];
  const ServerRoom& room = server_.rooms[session.room];
  for (std::uint8_t slot = 0; slot < room.guests.size(); ++slot) {
    const ServerGuest& guest = room.guests[slot];
    if (guest.in_use && guest.retained.is_set && now - guest.last_pose > kStillMoves &&
        !session.filters[slot].frames().is_of(guest.retained.record.stream))
      send_retained(to, slot, now);
  }
}

}  // namespace dance

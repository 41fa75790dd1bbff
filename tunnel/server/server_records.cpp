// The way of poses and hands through the server.
#include <algorithm>
#include <cstring>

#include "core/base/assert.h"
#include "tunnel/server/server_core.h"

namespace dance {
namespace {

// A capture further from now than this is no capture of a dance under way.
constexpr std::int64_t kLongestAge_us = 60'000'000;
// Nothing is captured in the future; clocks are mapped better than this.
constexpr std::int64_t kFarthestAhead_us = 1'000'000;
// Loss, round trip and the number of guests; then each of them.
constexpr std::size_t kFeedbackHead = 2 + 2 + 2 + 1;
constexpr std::size_t kFeedbackGuest = 7 + 1 + 4;

}  // namespace

void ServerCore::on_records(std::size_t index, wire::Bytes body, MonoTime received, MonoTime now) {
  ByteReader in(body);
  const auto header = wire::parse_records_header(in);
  // What receivers have is the server's to say.
  if (!header || header->has_feedback) return reject(ServerReject::kMalformed);
  // All of a datagram or nothing: half of a damaged one is not worth more than none.
  const wire::RecordChain begin{received.since_zero_us()};
  ByteReader check = in;
  for (wire::RecordChain chain = begin; check.remaining() > 0;)
    if (!wire::parse_record(chain, check)) return reject(ServerReject::kMalformed);
  // Until the welcome has come a link dances on in the session before: other slots, other numbers.
  if (!sessions_[index].knows_epoch) return reject(ServerReject::kLate);
  sessions_[index].stream.received.note(header->number);
  if (header->has_acks) on_acks(index, header->acks, now);
  for (const std::uint8_t slot : header->wants) on_want(index, slot, now);
  if (header->has_records && !may_send_records(sessions_[index].access))
    return reject(ServerReject::kNotAllowed);
  for (wire::RecordChain chain = begin; in.remaining() > 0;)
    on_record(index, *wire::parse_record(chain, in), received, now);
}

void ServerCore::on_record(std::size_t session, wire::Record record, MonoTime received,
                           MonoTime now) {
  if (record.kind == wire::RecordKind::kChannel)
    return on_channel_record(session, std::move(record), now);
  ServerGuest* guest = guest_of(session, record.slot);
  if (guest == nullptr) return reject(ServerReject::kForeignSlot);
  const std::int64_t received_us = received.since_zero_us();
  if (record.capture_us < received_us - kLongestAge_us ||
      record.capture_us > received_us + kFarthestAhead_us)
    return reject(ServerReject::kBadTime);
  if (!guest->records.take(1.0, now)) return reject(ServerReject::kGuestRate);
  const bool is_pose = record.kind == wire::RecordKind::kPose;
  StreamGate& gate = is_pose ? guest->poses : guest->hands;
  // The link need not know the generation.
  record.stream &= 0xffff;
  const bool is_narrow = record.is_narrow;
  if (!wire::widen(0, gate.has_any(), gate.stream(), gate.newest(), record) ||
      (is_narrow && gate.contradicts(record.sequence, record.capture_us)))
    return reject(ServerReject::kLate);
  record.stream |= std::uint32_t{guest->generation} << 16;
  switch (gate.judge(record.stream, record.sequence, record.capture_us)) {
    case StreamGate::Verdict::kNewest:
    case StreamGate::Verdict::kNewStream:
      break;
    case StreamGate::Verdict::kDuplicate:
      return reject(ServerReject::kDuplicate);
    case StreamGate::Verdict::kLate:
    case StreamGate::Verdict::kOldStream:
      return reject(ServerReject::kLate);
  }
  if (record.sent_age_us != wire::kNoAge)
    record.server_age_us = static_cast<std::int32_t>(received_us - record.capture_us);
  ++counters_.records_in;
  if (is_pose) guest->jitter.add(record.capture_us, received_us);
  if (record.is_base) ++guest->base_count;
  if (!is_pose) ++guest->hands_count;
  if (is_pose) guest->last_pose = now;
  if (is_pose && record.needs_no_other) keep(*guest, record);
  forward(session, record, now);
  if (is_pose) guest->previous.keep(record);
}

// Limited by itself, so that channels take nothing from poses, and none delays or drops another's.
void ServerCore::on_channel_record(std::size_t session, wire::Record record, MonoTime now) {
  ServerGuest* guest = guest_of(session, record.slot);
  if (guest == nullptr) return reject(ServerReject::kForeignSlot);
  if (!guest->channel_records.take(1.0, now) ||
      !guest->channel_bytes.take(static_cast<double>(record.payload.size()), now))
    return reject(ServerReject::kChannelRate);
  ChannelGate& gate = guest->channels[record.channel];
  if (gate.has_any && !is_newer_sequence(record.sequence, gate.sequence))
    return reject(ServerReject::kLate);
  gate = {true, record.sequence};
  record.stream = std::uint32_t{guest->generation} << 16;
  ++counters_.records_in;
  forward(session, record, now);
}

void ServerCore::forward(std::size_t from, const wire::Record& record, MonoTime now) {
  ServerRoom& room = rooms_[sessions_[from].room];
  // Once for each guest: without the proportions nobody could decode the pose.
  if (room.has_first_body) send_fresh_states(room, now);
  for (const std::size_t member : room.members) {
    if (member == from || !take_share(member, record, now)) continue;
    if (record.kind == wire::RecordKind::kPose)
      repeat_before(member, room.guests[record.slot], record, now);
    add_to_bundle(member, record, now);
  }
}

// The pose before goes once more, in front of this one, to whom it may be lost. Who gets only some
// poses gets those that need no other, or few: there it would be of no use.
void ServerCore::repeat_before(std::size_t member, const ServerGuest& guest,
                               const wire::Record& next, MonoTime now) {
  ServerSession& to = sessions_[member];
  if (!to.repeats_down.is_on() || to.filters[next.slot].divider() != 1 ||
      !guest.previous.is_before(next))
    return;
  put_in_bundle(member, guest.previous.again(), now);
  ++counters_.records_repeated;
}

void ServerCore::add_to_bundle(std::size_t index, const wire::Record& record, MonoTime now) {
  put_in_bundle(index, record, now);
  ServerSession& to = sessions_[index];
  if (record.kind == wire::RecordKind::kPose) {
    to.stream.sent.add({record.stream, static_cast<std::uint16_t>(record.sequence), record.slot});
    to.stream.bundle.count_pose();
  }
  ++counters_.records_out;
}

void ServerCore::put_in_bundle(std::size_t index, const wire::Record& record, MonoTime now) {
  ServerSession& to = sessions_[index];
  RecordBundler& bundle = to.stream.bundle;
  if (!bundle.has_room_for(record)) flush_bundle(index, now);
  if (bundle.is_empty()) bundled_.push_back(index);
  wire::Record told = record;
  told.needs_no_other = told.is_base = false;  // the receiver sees it
  to.filters[record.slot].tell_left_out(told);
  bundle.add(told, is_narrow_for(to.filters[record.slot].frames(), record), now.since_zero_us(),
             now + share_window(rooms_[to.room]));
}

Duration ServerCore::share_window(const ServerRoom& room) const {
  return limits_.share_window.value_or(share_window_of(room.guest_count));
}

// Who wants less than all of everybody waits: what comes next is not known.
bool ServerCore::is_bundle_due(const ServerSession& session, MonoTime now) const {
  return session.stream.bundle.is_due(now,
                                      session.full_shares > 0 ? session.full_shares : SIZE_MAX);
}

void ServerCore::flush_bundle(std::size_t index, MonoTime now) {
  if (!sessions_[index].stream.bundle.is_empty()) send_records(index, now);
  std::erase(bundled_, index);
}

// The bundle, if there is one, and the feedback, if it is due.
void ServerCore::send_records(std::size_t index, MonoTime now) {
  ServerSession& session = sessions_[index];
  Stream& stream = session.stream;
  wire::RecordsHeader header;
  if (session.feedback_due.is_set() && session.feedback_due <= now &&
      stream.bundle.room() >= kFeedbackHead + kFeedbackGuest * session.slots.size()) {
    // Links count what the server has of them; seldom is enough.
    const bool is_repeat = session.feedback_is_repeat;
    header.has_feedback = fill_feedback(index, now, header.feedback);
    if (header.has_feedback && is_repeat) stream.received.fill(header);
  }
  if (stream.bundle.is_empty() && !header.has_feedback) return;
  std::array<std::uint8_t, wire::kMaxPlain> bytes;
  send(session.peer, stream.write(header, true, bytes));
}

}  // namespace dance

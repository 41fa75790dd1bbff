#include "tunnel/link/signals/link_receiver.h"

#include <algorithm>

namespace dance {
namespace {

// Twice the server's limit: the network adds delay.
constexpr std::int64_t kOldestTold_us = 120'000'000;
constexpr std::int64_t kFarthestTold_us = 2'000'000;
constexpr Duration kLeastWantGap = Duration::ms(50);
constexpr Duration kLongestWantGap = Duration::s(1);

MonoTime hop_time(MonoTime capture, std::int32_t age_us) {
  return age_us == wire::kNoAge ? MonoTime() : capture + Duration::us(age_us);
}

}  // namespace

bool LinkReceiver::on_records(wire::Bytes body, MonoTime received, MonoTime now) {
  ByteReader in(body);
  const auto header = wire::parse_records_header(in);
  if (!header || !header->wants.empty()) return false;
  const wire::RecordChain begin{link_.clock.to_theirs_us(now)};
  ByteReader check = in;
  for (wire::RecordChain chain = begin; check.remaining() > 0;)
    if (!wire::parse_record(chain, check)) return false;
  if (header->has_acks) sender_.on_acks(header->acks);
  if (header->has_feedback) sender_.on_feedback(header->number, header->feedback, now);
  if (header->has_records) heard_records_ = now;
  const bool is_again = link_.stream.received.has(header->number);
  AckTracker::Slots failed;
  bool has_decoded = false;
  for (wire::RecordChain chain = begin; in.remaining() > 0;) {
    const std::size_t before = in.remaining();
    const wire::Record record = *wire::parse_record(chain, in);
    if (record.kind != wire::RecordKind::kChannel)
      link_.remotes[record.slot].counts.bytes += before - in.remaining();
    if (on_record(record, received, now))
      has_decoded = true;
    else if (!failed.contains(record.slot))
      (void)failed.try_push(record.slot);  // as many as there are slots
  }
  // A datagram of which nothing decoded is as good as lost; of others the failed guests are
  // excepted. An acknowledgement alone is not acknowledged: that would never end.
  if (is_again || (header->has_records && !has_decoded)) return true;
  if (link_.stream.received.note_except(header->number, failed) && header->has_records)
    link_.stream.received.owe(sender_.when_to_acknowledge(now), link_.is_path_clean(), now);
  return true;
}

bool LinkReceiver::on_record(wire::Record record, MonoTime received, MonoTime now) {
  if (record.kind == wire::RecordKind::kChannel) {
    channels_.on_record(record, now);
    return true;
  }
  const bool is_pose = record.kind == wire::RecordKind::kPose;
  RemoteGuest& remote = link_.remotes[record.slot];
  StreamGate& gate = is_pose ? remote.heard.poses : remote.heard.hands;
  const bool is_narrow = record.is_narrow;
  if (!remote.in_use || remote.is_ours ||
      !wire::widen(remote.generation, gate.has_any(), gate.stream(), gate.newest(), record)) {
    link_.counters.poses_received += is_pose ? 1 : 0;
    ++link_.counters.unrouted;  // the roster that names it has not come, or it has left
    return !is_pose;
  }
  const std::int64_t server_now_us = link_.clock.to_theirs_us(now);
  // Who has not moved for long was captured long ago.
  if ((record.capture_us < server_now_us - kOldestTold_us && !record.is_retained) ||
      record.capture_us > server_now_us + kFarthestTold_us) {
    link_.counters.poses_received += is_pose ? 1 : 0;
    ++link_.counters.invalid;
    ++remote.counts.invalid;
    return !is_pose;
  }
  if (is_narrow && gate.contradicts(record.sequence, record.capture_us)) {
    link_.counters.poses_received += is_pose ? 1 : 0;
    ++link_.counters.late;
    return !is_pose;
  }
  const auto left_out = record.counts_left_out ? std::optional(record.left_out) : std::nullopt;
  const StreamGate::Verdict verdict =
      gate.judge(record.stream, record.sequence, record.capture_us, left_out);
  const bool is_newest =
      verdict == StreamGate::Verdict::kNewest || verdict == StreamGate::Verdict::kNewStream;
  // The retained one is said again until it could be decoded: its proportions may have come later.
  const bool is_awaited =
      record.is_retained && !remote.heard.has_decoded && verdict != StreamGate::Verdict::kOldStream;
  // Once more, in case it was lost: it was not.
  if (verdict == StreamGate::Verdict::kDuplicate && !is_awaited) return true;
  link_.counters.poses_received += is_pose ? 1 : 0;
  if (!is_newest && !is_awaited) {
    ++link_.counters.late;
    return !is_pose;
  }
  if (record.is_retained) gate.exempt_gap();
  const MonoTime capture = link_.clock.to_ours(record.capture_us);
  if (!is_pose) {
    on_hands(record, remote.id, capture, now);
    return true;
  }
  if (verdict == StreamGate::Verdict::kNewStream) remote.decoder->restart();
  if (!decode(remote, record, now)) return false;
  remote.heard.has_decoded = true;
  // The stage already showed something newer than this pose, which the server kept.
  if (record.is_retained && remote.shown.is_set() && capture <= remote.shown) return true;
  remote.shown = capture;
  decoded_.sequence = record.sequence;
  decoded_.clock_id = link_.options.clock_id;
  decoded_.capture_time = capture;
  decoded_.hops = {};
  decoded_.stamp(Hop::kPublished, hop_time(capture, record.published_age_us));
  decoded_.stamp(Hop::kLinkSent, hop_time(capture, record.sent_age_us));
  decoded_.stamp(Hop::kServer, hop_time(capture, record.server_age_us));
  decoded_.stamp(Hop::kLinkReceived, received);
  ++link_.counters.poses_delivered;
  if (link_.handlers.on_pose) link_.handlers.on_pose(remote.id, decoded_, now);
  return true;
}

void LinkReceiver::on_hands(const wire::Record& record, const GuestId& id, MonoTime capture,
                            MonoTime now) {
  if (!decode_hands(record.payload, decoded_hands_)) {
    ++link_.counters.invalid;
    return;
  }
  decoded_hands_.sequence = record.sequence;
  decoded_hands_.clock_id = link_.options.clock_id;
  decoded_hands_.capture_time = capture;
  ++link_.counters.hands_delivered;
  if (link_.handlers.on_hands) link_.handlers.on_hands(id, decoded_hands_, now);
}

bool LinkReceiver::decode(RemoteGuest& remote, const wire::Record& record, MonoTime now) {
  switch (remote.decoder->decode(record.sequence, record.payload, decoded_)) {
    case DecodeResult::kPose:
      return true;
    case DecodeResult::kReferenceMissing:
      ++link_.counters.reference_missing;
      ++remote.counts.reference_missing;
      want_intra_frame(remote, now);
      return false;
    case DecodeResult::kSkeletonMissing:  // the server says it again until it has come
      ++link_.counters.skeleton_missing;
      ++remote.counts.skeleton_missing;
      return false;
    case DecodeResult::kMalformed:
      break;
  }
  ++link_.counters.invalid;
  ++remote.counts.invalid;
  return false;
}

void LinkReceiver::want_intra_frame(RemoteGuest& remote, MonoTime now) {
  const Duration gap =
      std::clamp(link_.clock.newest_round_trip() * 2, kLeastWantGap, kLongestWantGap);
  if (remote.intra_asked_at.is_set() && now - remote.intra_asked_at < gap) return;
  const auto slot = link_.remotes.slot_of(remote);
  if (!link_.stream.received.want_intra_frame(slot, now)) return;  // its next failure asks again
  remote.intra_asked_at = now;
  ++remote.counts.intra_frames_asked;
  ++link_.counters.intra_frames_asked;
}

}  // namespace dance

// From the server to this house.
#include <algorithm>

#include "tunnel/link/link_core.h"

namespace dance {
namespace {

// Twice what the server lets through: the way from there takes its time too.
constexpr std::int64_t kOldestTold_us = 120'000'000;
constexpr std::int64_t kFarthestTold_us = 2'000'000;

MonoTime hop_time(MonoTime capture, std::int32_t age_us) {
  return age_us == wire::kNoAge ? MonoTime() : capture + Duration::us(age_us);
}

}  // namespace

bool LinkCore::on_records(wire::Bytes body, MonoTime received, MonoTime now) {
  ByteReader in(body);
  const auto header = wire::parse_records_header(in);
  if (!header || !header->wants.empty()) return false;
  const wire::RecordChain begin{clock_.to_theirs_us(now)};
  ByteReader check = in;
  for (wire::RecordChain chain = begin; check.remaining() > 0;)
    if (!wire::parse_record(chain, check)) return false;
  if (header->has_acks) on_acks(header->acks);
  if (header->has_feedback) on_feedback(header->number, header->feedback, now);
  if (header->has_records) heard_records_ = now;
  const bool is_again = stream_.received.has(header->number);
  AckTracker::Slots failed;
  bool has_decoded = false;
  for (wire::RecordChain chain = begin; in.remaining() > 0;) {
    const wire::Record record = *wire::parse_record(chain, in);
    if (on_record(record, received, now))
      has_decoded = true;
    else if (!failed.contains(record.slot))
      (void)failed.try_push(record.slot);  // as many as there are slots
  }
  // A datagram of which nothing decoded is as good as lost; of others the failed guests are
  // excepted. An acknowledgement alone is not acknowledged: that would never end.
  if (is_again || (header->has_records && !has_decoded)) return true;
  if (stream_.received.note_except(header->number, failed) && header->has_records)
    stream_.received.owe(when_to_acknowledge(now), now);
  return true;
}

bool LinkCore::on_record(wire::Record record, MonoTime received, MonoTime now) {
  if (record.kind == wire::RecordKind::kChannel) {
    on_channel_record(record, now);
    return true;
  }
  const bool is_pose = record.kind == wire::RecordKind::kPose;
  RemoteGuest& remote = remotes_[record.slot];
  StreamGate& gate = is_pose ? remote.poses : remote.hands;
  const bool is_narrow = record.is_narrow;
  if (!remote.in_use || remote.is_ours ||
      !wire::widen(remote.generation, gate.has_any(), gate.stream(), gate.newest(), record)) {
    counters_.poses_received += is_pose ? 1 : 0;
    ++counters_.unrouted;  // the roster that names it has not come, or it has left
    return !is_pose;
  }
  const std::int64_t server_now_us = clock_.to_theirs_us(now);
  // Who has not moved for long was captured long ago.
  if ((record.capture_us < server_now_us - kOldestTold_us && !record.is_kept) ||
      record.capture_us > server_now_us + kFarthestTold_us) {
    counters_.poses_received += is_pose ? 1 : 0;
    ++counters_.invalid;
    ++remote.invalid;
    return !is_pose;
  }
  if (is_narrow && gate.contradicts(record.sequence, record.capture_us)) {
    counters_.poses_received += is_pose ? 1 : 0;
    ++counters_.late;
    return !is_pose;
  }
  const auto left_out = record.counts_left_out ? std::optional(record.left_out) : std::nullopt;
  const StreamGate::Verdict verdict =
      gate.judge(record.stream, record.sequence, record.capture_us, left_out);
  const bool is_newest =
      verdict == StreamGate::Verdict::kNewest || verdict == StreamGate::Verdict::kNewStream;
  // The kept one is said again until it could be decoded: its proportions may have come after it.
  const bool is_awaited =
      record.is_kept && !remote.has_decoded && verdict != StreamGate::Verdict::kOldStream;
  // Once more, in case it was lost: it was not.
  if (verdict == StreamGate::Verdict::kDuplicate && !is_awaited) return true;
  counters_.poses_received += is_pose ? 1 : 0;
  if (!is_newest && !is_awaited) {
    ++counters_.late;
    return !is_pose;
  }
  if (record.is_kept) gate.forgive_gap();
  const MonoTime capture = clock_.to_ours(record.capture_us);
  if (!is_pose) {
    on_hands(record, remote.id, capture, now);
    return true;
  }
  if (verdict == StreamGate::Verdict::kNewStream) remote.decoder->restart();
  if (!decode(remote, record, now)) return false;
  remote.has_decoded = true;
  // Through another sealed session the stage has seen more than the server kept.
  if (record.is_kept && remote.shown.is_set() && capture <= remote.shown) return true;
  remote.shown = capture;
  decoded_.sequence = record.sequence;
  decoded_.clock_id = options_.clock_id;
  decoded_.capture_time = capture;
  decoded_.hops = {};
  decoded_.stamp(Hop::kPublished, hop_time(capture, record.published_age_us));
  decoded_.stamp(Hop::kLinkSent, hop_time(capture, record.sent_age_us));
  decoded_.stamp(Hop::kServer, hop_time(capture, record.server_age_us));
  decoded_.stamp(Hop::kLinkReceived, received);
  ++counters_.poses_delivered;
  if (handlers_.on_pose) handlers_.on_pose(remote.id, decoded_, now);
  return true;
}

void LinkCore::on_hands(const wire::Record& record, const GuestId& id, MonoTime capture,
                        MonoTime now) {
  if (!decode_hands(record.payload, decoded_hands_)) {
    ++counters_.invalid;
    return;
  }
  decoded_hands_.sequence = record.sequence;
  decoded_hands_.clock_id = options_.clock_id;
  decoded_hands_.capture_time = capture;
  ++counters_.hands_delivered;
  if (handlers_.on_hands) handlers_.on_hands(id, decoded_hands_, now);
}

bool LinkCore::decode(RemoteGuest& remote, const wire::Record& record, MonoTime now) {
  switch (remote.decoder->decode(record.sequence, record.payload, decoded_)) {
    case DecodeResult::kPose:
      return true;
    case DecodeResult::kReferenceMissing:
      ++counters_.reference_missing;
      ++remote.reference_missing;
      want_key_frame(remote, now);
      return false;
    case DecodeResult::kSkeletonMissing:  // the server says it again until it has come
      ++counters_.skeleton_missing;
      ++remote.skeleton_missing;
      return false;
    case DecodeResult::kMalformed:
      break;
  }
  ++counters_.invalid;
  ++remote.invalid;
  return false;
}

void LinkCore::renew_decoder(RemoteGuest& remote) {
  remote.decoder = options_.make_decoder(codec_);
  remote.key_asked_at = MonoTime();
  // Only what this guest has told since it came: its encoder begins with nothing too.
  if (remote.state_versions[wire::place_of({wire::StateKind::kSkeleton, 0})] != 0 &&
      remote.has_skeleton)
    remote.decoder->set_skeleton(remote.skeleton);
}

bool LinkCore::is_present(const GuestId& id) const {
  return std::any_of(remotes_.begin(), remotes_.end(),
                     [&](const RemoteGuest& r) { return r.in_use && !r.is_ours && r.id == id; });
}

void LinkCore::settle_slot(RemoteGuest& remote, const wire::RosterEntry* entry) {
  if (entry == nullptr) {
    keep_counts(remote);
    remote.in_use = false;
    return;
  }
  const bool is_same =
      remote.in_use && remote.id == entry->guest && remote.generation == entry->slot.generation;
  if (!is_same) keep_counts(remote);
  remote.is_ours = is_ours(*entry);
  if (is_same) return;
  // What was known of the guest's proportions, in this slot or another, still holds until the
  // server says more.
  const auto known = std::find_if(remotes_.begin(), remotes_.end(), [&](const RemoteGuest& r) {
    return r.has_skeleton && r.id == entry->guest;
  });
  remote.has_skeleton = known != remotes_.end();
  if (remote.has_skeleton) remote.skeleton = known->skeleton;
  remote.in_use = true;
  remote.id = entry->guest;
  remote.generation = entry->slot.generation;
  remote.poses = StreamGate();
  remote.hands = StreamGate();
  remote.has_decoded = false;
  remote.shown = MonoTime();
  remote.invalid = 0;
  remote.reference_missing = 0;
  remote.skeleton_missing = 0;
  remote.key_frames_asked = 0;
  remote.state_versions = {};
  remote.channels = {};
  renew_decoder(remote);
}

bool LinkCore::on_roster(wire::Bytes body, MonoTime now) {
  const auto part = wire::parse_roster(body);
  if (!part) return false;
  if (!roster_.take(*part)) return true;  // overtaken by a newer one: nothing wrong with it
  FixedList<GuestId, wire::kMaxGuestsPerRoom> before;
  FixedList<GuestId, wire::kMaxGuestsPerRoom> named;
  for (const RemoteGuest& remote : remotes_)
    if (remote.in_use && !remote.is_ours && !before.try_push(remote.id)) return false;
  for (std::size_t i = 0; i < part->slot_span; ++i) {
    const std::size_t slot = part->first_slot + i;
    const auto entry = std::find_if(part->entries.begin(), part->entries.end(),
                                    [&](const auto& e) { return e.slot.slot == slot; });
    const bool is_taken = entry != part->entries.end();
    settle_slot(remotes_[slot], is_taken ? entry : nullptr);
    if (is_taken && !remotes_[slot].is_ours && !named.try_push(entry->guest)) return false;
  }
  settle_interest();
  // Who merely changed the slot neither left nor came.
  for (const GuestId& id : before)
    if (!is_present(id) && handlers_.on_guest_left) handlers_.on_guest_left(id, now);
  for (const GuestId& id : named)
    if (!before.contains(id) && handlers_.on_guest_joined) handlers_.on_guest_joined(id, now);
  return true;
}

}  // namespace dance

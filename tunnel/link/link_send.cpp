// From this house to the server.
#include <algorithm>
#include <cstring>

#include "core/base/assert.h"
#include "tunnel/link/link_core.h"

namespace dance {
namespace {

// Half of what the server takes, so that clocks may be off and a line slow.
constexpr Duration kOldestCapture = Duration::s(30);
constexpr Duration kFarthestAhead = Duration::ms(500);
constexpr Duration kDancesOnInLapse = Duration::s(10);
constexpr Duration kStillDancing = Duration::ms(100);

std::int32_t age_us(MonoTime step, MonoTime capture) {
  if (!step.is_set()) return wire::kNoAge;
  const std::int64_t us = (step - capture).count_us();
  return us > -INT32_MAX && us < INT32_MAX ? static_cast<std::int32_t>(us) : wire::kNoAge;
}

}  // namespace

bool LinkCore::stamp(MonoTime capture, std::uint64_t clock_id, MonoTime published, MonoTime now,
                     Stamp& out) {
  if (clock_id != options_.clock_id || !capture.is_set()) {
    // Stamps of a clock that we do not know cannot be compared with ours: it is taken as made now.
    ++counters_.foreign_clock;
    capture = now;
    published = MonoTime();
  }
  const Duration age = now - capture;
  if (age > kOldestCapture || age < -kFarthestAhead) return false;
  out.capture = capture;
  // In the wire's ticks from the begin, so that nobody rounds it again; ages count from there.
  const std::int64_t exact_us = clock_.to_theirs_us(capture);
  out.capture_us = wire::to_ticks(exact_us) * wire::kTick_us;
  const MonoTime sent = capture + Duration::us(out.capture_us - exact_us);
  out.published_age_us = age_us(published, sent);
  out.sent_age_us = age_us(now, sent);
  return true;
}

// Guests of whom something came of late: whose records are worth waiting for.
std::size_t LinkCore::count_dancing(MonoTime now) const {
  return static_cast<std::size_t>(std::count_if(locals_.begin(), locals_.end(), [&](const auto& g) {
    return g.has_slot && now - g.last_pose < kStillDancing;
  }));
}

void LinkCore::add_record(const wire::Record& record, MonoTime now) {
  put(record, now);
  if (record.kind == wire::RecordKind::kPose) stream_.bundle.count_pose();
  if (stream_.bundle.is_due(now, count_dancing(now))) flush_records(now);
}

// What the others have, the server has: from there it reckons the high bits.
bool LinkCore::is_narrow(const wire::Record& record) const {
  for (const LocalGuest& guest : locals_)
    if (guest.has_slot && guest.slot.slot == record.slot)
      return is_narrow_for(guest.references.acked_frames(), record);
  return false;
}

// Through a lapse too: the others may hear what this link does not, and what first comes through a
// line that was cut is a pose, not a hello. Until the server has surely forgotten the session.
bool LinkCore::may_send(MonoTime now) const {
  return is_connected() ||
         (state_ == LinkState::kLapsed && is_welcome_ && now - last_heard_ < kDancesOnInLapse);
}

// The pose before goes once more, in front of this one.
void LinkCore::repeat_before(LocalGuest& guest, const wire::Record& next, MonoTime now) {
  if (wants_repeats_ && guest.previous.is_before(next)) {
    put(guest.previous.again(), now);
    ++counters_.poses_repeated;
  }
  guest.previous.keep(next);
}

void LinkCore::put(const wire::Record& record, MonoTime now) {
  if (!stream_.bundle.has_room_for(record)) flush_records(now);
  stream_.bundle.add(record, is_narrow(record), clock_.to_theirs_us(now),
                     now + options_.share_window);
}

// What waits, with what there is to acknowledge: ahead of the records where there is no room.
void LinkCore::flush_records(MonoTime now) {
  const bool is_ripe = stream_.received.is_ripe(now, is_way_clean());
  const std::size_t extras = is_ripe ? stream_.received.extra_bytes() : 0;
  if (stream_.bundle.is_empty() || stream_.bundle.room() < extras)
    send_records_datagram(false, now);
  if (!stream_.bundle.is_empty()) send_records_datagram(true, now);
}

void LinkCore::send_records_datagram(bool with_records, MonoTime now) {
  wire::RecordsHeader header;
  if (stream_.received.is_ripe(now, is_way_clean())) stream_.received.tell(header, now);
  std::array<std::uint8_t, wire::kMaxPlain> bytes;
  send_datagram(stream_.write(header, with_records, bytes));
}

void LinkCore::send(const GuestId& id, const Pose& pose, MonoTime now) {
  ++counters_.poses_offered;
  LocalGuest* guest = find_or_add(id, now);
  if (guest == nullptr) return;
  if (!may_send(now) || !guest->has_slot) {
    ++counters_.unrouted;
    return;
  }
  std::array<std::uint8_t, kMaxPosePayload> payload;
  wire::Record record;
  Stamp times{};
  if (!is_valid(pose) ||
      !stamp(pose.capture_time, pose.clock_id, pose.stamped(Hop::kPublished), now, times)) {
    ++counters_.invalid;
    return;
  }
  const std::uint64_t restarts = guest->poses.restarts();
  if (!guest->poses.advance(pose.sequence, times.capture, pose.clock_id)) {
    ++counters_.late;
    return;
  }
  if (guest->poses.restarts() != restarts) {
    ++counters_.stream_restarts;
    guest->references.restart(*guest->encoder, guest->poses.stream());
    guest->unstamped = 0;
  }
  const bool is_base =
      guest->references.prepare(*guest->encoder, times.capture, options_.key_frame_period, now);
  // Only what is sent: an encoder may refer to what it encoded before.
  const std::size_t size = guest->encoder->encode(pose, payload);
  if (size == 0) {
    ++counters_.invalid;
    return;
  }
  if (guest->quality.add(size, now)) guest->encoder->set_quality(guest->quality.quality_m());
  record.kind = wire::RecordKind::kPose;
  record.slot = guest->slot.slot;
  record.stream = guest->poses.stream();
  record.sequence = pose.sequence;
  record.capture_us = times.capture_us;
  record.needs_no_other = guest->encoder->needs_no_other();
  record.is_base = is_base;
  if (guest->unstamped == 0) {
    record.published_age_us = times.published_age_us;
    record.sent_age_us = times.sent_age_us;
  }
  guest->unstamped = (guest->unstamped + 1) % std::max(options_.poses_per_stamp, 1u);
  record.payload = {payload.data(), size};
  guest->references.note_sent(record.sequence, record.needs_no_other, now);
  ++counters_.poses_sent;
  repeat_before(*guest, record, now);
  add_record(record, now);
}

void LinkCore::send(const GuestId& id, const Hands& hands, MonoTime now) {
  LocalGuest* guest = find_or_add(id, now);
  if (guest == nullptr || !may_send(now) || !guest->has_slot) return;
  std::array<std::uint8_t, kMaxHandsPayload> payload;
  Stamp times{};
  const std::size_t size = encode_hands(hands, payload);
  if (size == 0 || !stamp(hands.capture_time, hands.clock_id, MonoTime(), now, times) ||
      !guest->hands.advance(hands.sequence, times.capture, hands.clock_id))
    return;
  wire::Record record;
  record.kind = wire::RecordKind::kHands;
  record.slot = guest->slot.slot;
  record.stream = guest->hands.stream();
  record.sequence = hands.sequence;
  record.capture_us = times.capture_us;
  record.payload = {payload.data(), size};
  ++counters_.hands_sent;
  add_record(record, now);
}

void LinkCore::send(const GuestId& id, const Skeleton& skeleton, MonoTime now) {
  LocalGuest* guest = find_or_add(id, now);
  if (guest == nullptr) return;
  std::array<std::uint8_t, kSkeletonPayload> payload;
  const std::size_t size = encode_skeleton(skeleton, payload);
  if (size == 0) {
    ++counters_.invalid;
    return;
  }
  // Producers say it once a second: only a change is news.
  ReplicatedState& state = guest->states[wire::place_of({wire::StateKind::kSkeleton, 0})];
  if (!state.change({payload.data(), size})) return;
  // As the others get it: rounded.
  Skeleton rounded;
  if (guest->encoder && decode_skeleton(payload, rounded)) guest->encoder->set_skeleton(rounded);
  if (is_connected() && guest->has_slot && state_changes_.take(1.0, now))
    send_state({{wire::StateKind::kSkeleton, 0}, guest->slot, {}, state.version, state.bytes()});
}

}  // namespace dance

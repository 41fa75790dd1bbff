// From this house to the server.
#include <algorithm>
#include <cstring>

#include "core/base/assert.h"
#include "tunnel/link_core.h"

namespace dance {
namespace {

// Half of what the server takes, so that clocks may be off and a line slow.
constexpr Duration kOldestCapture = Duration::s(30);
constexpr Duration kFarthestAhead = Duration::ms(500);

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
  out.capture_us = clock_.to_theirs_us(capture);
  out.published_age_us = age_us(published, capture);
  out.sent_age_us = age_us(now, capture);
  return true;
}

void LinkCore::send_record(const wire::Record& record) {
  std::array<std::uint8_t, wire::kMaxDatagram> out;
  ByteWriter writer(out);
  wire::begin_records(session_, writer);
  wire::add_record(record, writer);
  DANCE_ASSERT(writer.ok());
  send_datagram(writer.written());
}

void LinkCore::send(const GuestId& id, const Pose& pose, MonoTime now) {
  ++counters_.poses_offered;
  LocalGuest* guest = find_or_add(id, now);
  if (guest == nullptr) return;
  if (!is_connected() || !guest->has_slot) {
    ++counters_.unrouted;
    return;
  }
  std::array<std::uint8_t, kMaxPosePayload> payload;
  wire::Record record;
  Stamp times{};
  const std::size_t size = guest->encoder->encode(pose, payload);
  if (size == 0 ||
      !stamp(pose.capture_time, pose.clock_id, pose.stamped(Hop::kPublished), now, times)) {
    ++counters_.invalid;
    return;
  }
  const std::uint64_t restarts = guest->poses.restarts();
  if (!guest->poses.advance(pose.sequence, times.capture, pose.clock_id)) {
    ++counters_.late;
    return;
  }
  counters_.stream_restarts += guest->poses.restarts() - restarts;
  record.kind = wire::RecordKind::kPose;
  record.slot = guest->slot.slot;
  record.stream = guest->poses.stream();
  record.sequence = pose.sequence;
  record.capture_us = times.capture_us;
  record.published_age_us = times.published_age_us;
  record.sent_age_us = times.sent_age_us;
  record.codec = static_cast<std::uint8_t>(codec_);
  record.payload = {payload.data(), size};
  send_record(record);
  ++counters_.poses_sent;
}

void LinkCore::send(const GuestId& id, const Hands& hands, MonoTime now) {
  LocalGuest* guest = find_or_add(id, now);
  if (guest == nullptr || !is_connected() || !guest->has_slot) return;
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
  record.sent_age_us = times.sent_age_us;
  record.payload = {payload.data(), size};
  send_record(record);
  ++counters_.hands_sent;
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
  if (guest->skeleton_version != 0 && payload == guest->skeleton) return;
  guest->skeleton = payload;
  ++guest->skeleton_version;
  if (guest->encoder) guest->encoder->set_skeleton(skeleton);
  if (is_connected() && guest->has_slot) send_skeleton(*guest);
}

void LinkCore::send_skeleton(const LocalGuest& guest) {
  wire::State state;
  state.slot = guest.slot;
  state.version = guest.skeleton_version;
  state.payload = guest.skeleton;
  std::array<std::uint8_t, wire::kMaxDatagram> out;
  send_datagram({out.data(), wire::build(session_, state, out)});
}

}  // namespace dance

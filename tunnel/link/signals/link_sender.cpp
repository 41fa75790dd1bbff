#include "tunnel/link/signals/link_sender.h"

#include <algorithm>

#include "core/base/assert.h"

namespace dance {
namespace {

// Half of what the server takes, so that clocks may be off and a path slow.
constexpr Duration kOldestCapture = Duration::s(30);
constexpr Duration kFarthestAhead = Duration::ms(500);
// One that only listens says it within this.
constexpr Duration kAckDelay = Duration::ms(5);
// A dancing link says it with its next pose, if that is due within this.
constexpr Duration kLongestAckDelay = Duration::ms(45);

std::int32_t age_us(MonoTime step, MonoTime capture) {
  if (!step.is_set()) return wire::kNoAge;
  const std::int64_t us = (step - capture).count_us();
  return us > -INT32_MAX && us < INT32_MAX ? static_cast<std::int32_t>(us) : wire::kNoAge;
}

}  // namespace

bool LinkSender::stamp(MonoTime capture, std::uint64_t clock_id, MonoTime published, MonoTime now,
                       Stamp& out) {
  if (clock_id != link_.options.clock_id || !capture.is_set()) {
    // Stamps of a clock that we do not know cannot be compared with ours: it is taken as made now.
    ++link_.counters.foreign_clock;
    capture = now;
    published = MonoTime();
  }
  const Duration age = now - capture;
  if (age > kOldestCapture || age < -kFarthestAhead) return false;
  out.capture = capture;
  // In the wire's ticks from the begin, so that nobody rounds it again; ages count from there.
  const std::int64_t exact_us = link_.clock.to_theirs_us(capture);
  out.capture_us = wire::to_ticks(exact_us) * wire::kTick_us;
  const MonoTime sent = capture + Duration::us(out.capture_us - exact_us);
  out.published_age_us = age_us(published, sent);
  out.sent_age_us = age_us(now, sent);
  return true;
}

void LinkSender::send(LocalGuest& guest, const Pose& pose, MonoTime now) {
  std::array<std::uint8_t, kMaxPosePayload> payload;
  wire::Record record;
  Stamp times{};
  if (!is_valid(pose) ||
      !stamp(pose.capture_time, pose.clock_id, pose.stamped(Hop::kPublished), now, times)) {
    ++link_.counters.invalid;
    return;
  }
  const std::uint64_t restarts = guest.poses.restarts();
  if (!guest.poses.advance(pose.sequence, times.capture, pose.clock_id)) {
    ++link_.counters.late;
    return;
  }
  if (guest.poses.restarts() != restarts) {
    ++link_.counters.stream_restarts;
    guest.references.restart(*guest.encoder, guest.poses.stream());
    guest.unstamped = 0;
  }
  const bool is_base = guest.references.prepare(*guest.encoder, times.capture,
                                                link_.options.intra_frame_period, now);
  // Only what is sent: an encoder may refer to what it encoded before.
  const std::size_t size = guest.encoder->encode(pose, payload);
  if (size == 0) {
    ++link_.counters.invalid;
    return;
  }
  guest.quality.add(size, now);
  settle_quality(guest, now);
  record.kind = wire::RecordKind::kPose;
  record.slot = guest.slot.slot;
  record.stream = guest.poses.stream();
  record.sequence = pose.sequence;
  record.capture_us = times.capture_us;
  record.is_intra = guest.encoder->is_intra();
  record.is_base = is_base;
  if (guest.unstamped == 0) {
    record.published_age_us = times.published_age_us;
    record.sent_age_us = times.sent_age_us;
  }
  guest.unstamped = (guest.unstamped + 1) % std::max(link_.options.poses_per_stamp, 1u);
  record.payload = {payload.data(), size};
  guest.references.note_sent(record.sequence, record.is_intra, now);
  ++link_.counters.poses_sent;
  // The pose before goes once more, in front of this one.
  if (wants_repeats_ && guest.previous.is_before(record)) {
    put(guest.previous.again(), now);
    ++link_.counters.poses_repeated;
  }
  guest.previous.keep(record);
  add(record, now);
}

void LinkSender::send(LocalGuest& guest, const Hands& hands, MonoTime now) {
  std::array<std::uint8_t, kMaxHandsPayload> payload;
  Stamp times{};
  const std::size_t size = encode_hands(hands, payload);
  if (size == 0 || !stamp(hands.capture_time, hands.clock_id, MonoTime(), now, times) ||
      !guest.hands.advance(hands.sequence, times.capture, hands.clock_id))
    return;
  wire::Record record;
  record.kind = wire::RecordKind::kHands;
  record.slot = guest.slot.slot;
  record.stream = guest.hands.stream();
  record.sequence = hands.sequence;
  record.capture_us = times.capture_us;
  record.payload = {payload.data(), size};
  ++link_.counters.hands_sent;
  add(record, now);
}

void LinkSender::add(const wire::Record& record, MonoTime now) {
  put(record, now);
  RecordBundler& bundle = link_.stream.bundle;
  if (record.kind == wire::RecordKind::kPose) bundle.count_pose();
  if (bundle.is_due(now, link_.locals.count_dancing(now))) flush(now);
}

void LinkSender::put(const wire::Record& record, MonoTime now) {
  RecordBundler& bundle = link_.stream.bundle;
  if (!bundle.has_room_for(record)) flush(now);
  // What the others have, the server has: from there it reckons the high bits.
  const LocalGuest* guest = link_.locals.find_slot(record.slot);
  const bool is_narrow =
      guest != nullptr && is_narrow_for(guest->references.acked_frames(), record);
  bundle.add(record, is_narrow, link_.clock.to_theirs_us(now), now + link_.options.share_window);
}

// What waits, with what there is to acknowledge: ahead of the records where there is no room.
void LinkSender::flush(MonoTime now) {
  const bool is_ripe = link_.stream.received.is_ripe(now, link_.is_path_clean());
  const std::size_t extras = is_ripe ? link_.stream.received.extra_bytes() : 0;
  if (link_.stream.bundle.is_empty() || link_.stream.bundle.room() < extras)
    send_datagram(false, now);
  if (!link_.stream.bundle.is_empty()) send_datagram(true, now);
}

void LinkSender::send_datagram(bool with_records, MonoTime now) {
  wire::RecordsHeader header;
  if (link_.stream.received.is_ripe(now, link_.is_path_clean()))
    link_.stream.received.tell(header, now);
  std::array<std::uint8_t, wire::kMaxPlain> bytes;
  link_.send(link_.stream.write(header, with_records, bytes));
}

void LinkSender::flush_acks(MonoTime now) {
  if (link_.stream.received.owes() && now >= link_.stream.received.due()) flush(now);
}

void LinkSender::flush_due(MonoTime now) {
  if (!link_.stream.bundle.is_empty() && now >= link_.stream.bundle.due()) flush(now);
}

MonoTime LinkSender::next_deadline() const {
  const MonoTime acks = link_.is_connected() ? link_.stream.received.due() : MonoTime();
  return earlier(acks, link_.stream.bundle.is_empty() ? MonoTime() : link_.stream.bundle.due());
}

void LinkSender::begin_session() {
  link_.stream = Stream();
  link_.path = PathStats();
  has_feedback_ = wants_repeats_ = false;
}

// Coarser where all receivers see the dancer from afar.
void LinkSender::settle_quality(LocalGuest& guest, MonoTime now) {
  constexpr double kFromAfar_m = 0.002;
  double quality_m = guest.quality.quality_m();
  if (guest.references.is_far_from_all(now)) quality_m = std::max(quality_m, kFromAfar_m);
  if (quality_m == guest.encoded_quality_m) return;
  guest.encoded_quality_m = quality_m;
  guest.encoder->set_quality(quality_m);
}

void LinkSender::begin_encoder(LocalGuest& guest) {
  guest.encoder = link_.options.make_encoder(link_.codec);
  DANCE_ASSERT(guest.encoder != nullptr, static_cast<int>(link_.codec.id), link_.codec.model);
  guest.references.begin(*guest.encoder);
  guest.encoded_quality_m = guest.quality.quality_m();
  guest.encoder->set_quality(guest.encoded_quality_m);
  guest.unstamped = 0;
  Skeleton skeleton;
  const ReplicatedState& state = guest.states[wire::place_of({wire::StateKind::kSkeleton, 0})];
  if (state.version != 0 && decode_skeleton(state.bytes(), skeleton))
    guest.encoder->set_skeleton(skeleton);
}

// Alone it would cost three times what it does with a pose, and wake both ends once more.
MonoTime LinkSender::when_to_acknowledge(MonoTime now) const {
  for (const LocalGuest& guest : link_.locals) {
    // A quarter late is in time.
    MonoTime next_pose = guest.last_pose + guest.references.frame() * 5 / 4;
    if (link_.is_path_clean() &&
        next_pose < link_.stream.received.told_at() + AckTracker::kCleanGap)
      next_pose += guest.references.frame();
    if (guest.has_slot && guest.last_pose.is_set() && next_pose > now &&
        next_pose - now <= kLongestAckDelay)
      return next_pose;
  }
  return now + kAckDelay;
}

void LinkSender::on_acks(const wire::Acks& acks) {
  const std::uint64_t before = link_.stream.sent.acked();
  link_.stream.sent.acknowledge(acks, [](const SentRing::Frame&) {});
  link_.counters.datagrams_acked += link_.stream.sent.acked() - before;
}

void LinkSender::on_feedback(std::uint16_t number, const wire::Feedback& feedback, MonoTime now) {
  // An older one says what a receiver that has come since does not have.
  if (has_feedback_ && static_cast<std::int16_t>(number - newest_feedback_) <= 0) return;
  has_feedback_ = true;
  newest_feedback_ = number;
  wants_repeats_ = feedback.wants_repeats;
  if (feedback.round_trip != 0)
    link_.path = PathStats{true, feedback.loss / 65535.0, feedback.in_a_row / 65535.0,
                           Duration::us(feedback.round_trip * std::int64_t{100})};
  for (const wire::GuestFeedback& about : feedback.guests) {
    LocalGuest* guest = link_.locals.find_slot(about.slot);
    if (guest == nullptr || !guest->encoder) continue;
    if (guest->references.take(about, link_.path, *guest->encoder, now))
      ++link_.counters.intra_frames_sent;
  }
}

}  // namespace dance

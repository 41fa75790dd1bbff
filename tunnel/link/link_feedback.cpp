// What this house has of the others, and what the others have of this house.
#include <algorithm>

#include "core/base/assert.h"
#include "tunnel/link/link_core.h"

namespace dance {
namespace {

// One that only listens says it within this.
constexpr Duration kAckDelay = Duration::ms(5);
// A dancing link says it with its next pose, if that is due within this.
constexpr Duration kLongestAckDelay = Duration::ms(45);
constexpr double kCleanLoss = 0.002;
constexpr Duration kLeastWantGap = Duration::ms(50);
constexpr Duration kLongestWantGap = Duration::s(1);

}  // namespace

void LinkCore::begin_session_records() {
  stream_ = Stream();
  has_feedback_ = wants_repeats_ = false;
  path_ = PathStats();
}

// For a guest whom nobody has heard in this slot: what was encoded before is no reference.
void LinkCore::settle_encoder(LocalGuest& guest) {
  guest.encoder = options_.make_encoder(codec_);
  DANCE_ASSERT(guest.encoder != nullptr, static_cast<int>(codec_.id), codec_.model);
  guest.references.begin(*guest.encoder);
  guest.encoder->set_quality(guest.quality.quality_m());
  guest.unstamped = 0;
  Skeleton skeleton;
  const ReplicatedState& state = guest.states[wire::place_of({wire::StateKind::kSkeleton, 0})];
  if (state.version != 0 && decode_skeleton(state.bytes(), skeleton))
    guest.encoder->set_skeleton(skeleton);
}

// Neither to the server nor from there to the worst of the others is much lost.
bool LinkCore::is_way_clean() const { return path_.is_known && path_.loss < kCleanLoss; }

// Alone it would cost three times what it does with a pose, and wake both ends once more.
MonoTime LinkCore::when_to_acknowledge(MonoTime now) const {
  for (const LocalGuest& guest : locals_) {
    // A quarter late is in time.
    MonoTime next_pose = guest.last_pose + guest.references.frame() * 5 / 4;
    if (is_way_clean() && next_pose < stream_.received.told_at() + AckTracker::kCleanGap)
      next_pose += guest.references.frame();
    if (guest.has_slot && guest.last_pose.is_set() && next_pose > now &&
        next_pose - now <= kLongestAckDelay)
      return next_pose;
  }
  return now + kAckDelay;
}

void LinkCore::want_key_frame(RemoteGuest& remote, MonoTime now) {
  const Duration gap = std::clamp(clock_.newest_round_trip() * 2, kLeastWantGap, kLongestWantGap);
  if (remote.key_asked_at.is_set() && now - remote.key_asked_at < gap) return;
  const auto slot = static_cast<std::uint8_t>(&remote - remotes_.data());
  if (!stream_.received.want_key_frame(slot, now)) return;  // its next failure asks again
  remote.key_asked_at = now;
  ++remote.key_frames_asked;
  ++counters_.key_frames_asked;
}

void LinkCore::on_acks(const wire::Acks& acks) {
  const std::uint64_t before = stream_.sent.acked();
  stream_.sent.acknowledge(acks, [](const SentRing::Frame&) {});
  counters_.datagrams_acked += stream_.sent.acked() - before;
}

void LinkCore::on_feedback(std::uint16_t number, const wire::Feedback& feedback, MonoTime now) {
  // An older one says what a receiver that has come since does not have.
  if (has_feedback_ && static_cast<std::int16_t>(number - newest_feedback_) <= 0) return;
  has_feedback_ = true;
  newest_feedback_ = number;
  wants_repeats_ = feedback.wants_repeats;
  if (feedback.round_trip != 0)
    path_ = PathStats{true, feedback.loss / 65535.0, feedback.in_a_row / 65535.0,
                      Duration::us(feedback.round_trip * std::int64_t{100})};
  for (const wire::GuestFeedback& about : feedback.guests)
    for (LocalGuest& guest : locals_)
      if (guest.has_slot && guest.slot.slot == about.slot && guest.encoder)
        counters_.key_frames_sent +=
            guest.references.take(about, path_, *guest.encoder, now) ? 1 : 0;
}

}  // namespace dance

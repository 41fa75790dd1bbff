// What receivers have, what they lack, and how senders are told.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/assert.h"
#include "tunnel/server/server_core.h"
#include "tunnel/session/reference_control.h"

namespace dance {
namespace {

constexpr Duration kFeedbackGap = Duration::ms(4);
// To who may refer to what is lost as well: just so often that silence tells of a cut.
constexpr Duration kCleanFeedbackGap = Duration::ms(50);
// Poses of others come by to go along with; not worth a datagram of its own before.
constexpr Duration kWaitsForCompany = Duration::ms(20);
constexpr Duration kFrame = Duration::us(16'667);
// However many ask, and however often.
constexpr Duration kKeyFrameGap = Duration::ms(100);
// A link says something each 200 ms, and with each pose: who has not for this long is waited for no
// more.
constexpr Duration kStillHere = Duration::ms(500);
// A newcomer wants at once what was asked for it already, and its way is not known yet.
constexpr Duration kNewcomersWay = Duration::ms(100);
constexpr std::uint32_t kLongestRoundTrip_us = 1'000'000;

Duration round_trip_of(const ServerSession& session) {
  return Duration::us(std::min(session.newest_ping.round_trip_us, kLongestRoundTrip_us));
}

}  // namespace

bool ServerCore::is_receiver(std::size_t member, std::size_t sender, MonoTime now) const {
  const ServerSession& session = sessions_[member];
  return member != sender && now - session.last_heard <= kStillHere;
}

void ServerCore::on_acks(std::size_t index, const wire::Acks& acks, MonoTime now) {
  ServerSession& session = sessions_[index];
  const ServerRoom& room = rooms_[session.room];
  const std::uint64_t before = session.stream.sent.acked();
  const bool is_good = session.stream.sent.acknowledge(acks, [&](const SentRing::Frame& frame) {
    const ServerGuest& guest = room.guests[frame.slot];
    if (!guest.in_use || guest.poses.stream() != frame.stream) return;
    session.filters[frame.slot].frames().add(frame.stream, frame.sequence);
    schedule_feedback(guest.owner, now);
  });
  counters_.datagrams_acked += session.stream.sent.acked() - before;
  if (limits_.repeats) session.repeats_down.update(session.stream.sent.loss());
  if (!is_good) reject(ServerReject::kBadAck);
}

void ServerCore::on_want(std::size_t index, std::uint8_t slot, MonoTime now) {
  ServerSession& session = sessions_[index];
  ServerGuest& guest = rooms_[session.room].guests[slot];
  if (!guest.in_use || guest.owner == index) return reject(ServerReject::kForeignSlot);
  InterestFilter& filter = session.filters[slot];
  filter.frames().clear();
  // Who gets frames that need no other has lost the first of them, or its proportions: the next
  // comes.
  if (filter.share() == Share::kStills) {
    filter.await_intra(true);
    return;
  }
  // The one that was asked for last may be under way still.
  const bool is_known = session.newest_ping.round_trip_us != 0;
  const Duration way =
      (is_known ? round_trip_of(session) : kNewcomersWay) + round_trip_of(sessions_[guest.owner]);
  if (guest.key_asked_at.is_set() && now - guest.key_asked_at < way) return;
  filter.await_intra(filter.share() == Share::kBase);
  want_key_frame(guest, now);
}

void ServerCore::want_key_frames_for(std::size_t newcomer, MonoTime now) {
  const ServerSession& session = sessions_[newcomer];
  for (std::size_t slot = 0; slot < session.filters.size(); ++slot) {
    ServerGuest& guest = rooms_[session.room].guests[slot];
    if (guest.in_use && guest.owner != newcomer && session.filters[slot].wants_any())
      want_key_frame(guest, now);
  }
}

void ServerCore::want_key_frame(ServerGuest& guest, MonoTime now) {
  ++counters_.key_frames_wanted;
  guest.key_wanted = true;
  ServerSession& owner = sessions_[guest.owner];
  const bool is_early = guest.key_asked_at.is_set() && now - guest.key_asked_at < kKeyFrameGap;
  const MonoTime at = is_early ? guest.key_asked_at + kKeyFrameGap : now;
  schedule_feedback(guest.owner, at, Duration(), kFeedbackGap);
  if (!is_early && owner.feedback_due.is_set())
    owner.feedback_due = owner.feedback_alone = std::min(owner.feedback_due, now);
}

// What was said may be lost.
void ServerCore::repeat_feedback(std::size_t index, MonoTime now) {
  sessions_[index].feedback_is_repeat = true;
  if (!sessions_[index].feedback_due.is_set())
    schedule_feedback(index, now, kWaitsForCompany, kFeedbackGap);
}

void ServerCore::schedule_feedback(std::size_t index, MonoTime now) {
  const bool is_clean = sessions_[index].bears_losses;
  schedule_feedback(index, now, kWaitsForCompany, is_clean ? kCleanFeedbackGap : kFeedbackGap);
}

// Not before `at`, and not more often than senders can make use of; alone when it has waited so
// long.
void ServerCore::schedule_feedback(std::size_t index, MonoTime at, Duration waits, Duration gap) {
  ServerSession& session = sessions_[index];
  if (session.slots.empty()) return;
  // With nobody to receive there is nothing to tell.
  if (rooms_[session.room].members.size() < 2) return;
  if (session.feedback_made.is_set()) at = std::max(at, session.feedback_made + gap);
  if (!session.feedback_due.is_set()) {
    session.feedback_due = at;
    session.feedback_alone = at + waits;
    reporting_.push_back(index);
  }
  session.feedback_due = std::min(session.feedback_due, at);
  session.feedback_alone = std::min(session.feedback_alone, at + waits);
}

wire::GuestFeedback ServerCore::feedback_about(std::size_t index, std::uint8_t slot,
                                               MonoTime now) const {
  const ServerRoom& room = rooms_[sessions_[index].room];
  const ServerGuest& guest = room.guests[slot];
  ReceiverSummary receivers(guest.poses.has_any(), guest.poses.stream(), guest.poses.newest());
  for (const std::size_t member : room.members)
    if (is_receiver(member, index, now)) {
      const InterestFilter& filter = sessions_[member].filters[slot];
      receivers.add(filter.divider(), filter.frames());
    }
  wire::GuestFeedback about;
  about.slot = slot;
  about.restarts = static_cast<std::uint8_t>(guest.poses.stream());
  about.key_frames = guest.key_frames;
  receivers.fill(about);
  return about;
}

bool ServerCore::fill_feedback(std::size_t index, MonoTime now, wire::Feedback& feedback) {
  ServerSession& session = sessions_[index];
  ServerRoom& room = rooms_[session.room];
  session.feedback_due = session.feedback_alone = MonoTime();
  session.feedback_made = now;
  std::erase(reporting_, index);
  bool is_news = std::exchange(session.feedback_is_repeat, false);

  session.bears_losses = false;
  float loss = 0.0f, in_a_row = 0.0f;
  Duration round_trip;
  bool has_receiver = false;
  for (const std::size_t member : room.members) {
    if (!is_receiver(member, index, now) || !wants_any_of(sessions_[member], session)) continue;
    has_receiver = true;
    const LossMeter& down = sessions_[member].stream.sent.loss();
    loss = std::max(loss, sessions_[member].repeats_down.residual(down));
    in_a_row = std::max(in_a_row, down.in_a_row());
    round_trip = std::max(round_trip, round_trip_of(sessions_[member]));
  }
  if (has_receiver) {
    // What is lost on either way does not arrive.
    const LossMeter& up = session.stream.received.loss();
    if (limits_.repeats) session.repeats_up.update(up);
    feedback.wants_repeats = session.repeats_up.is_on();
    const float lost_up = session.repeats_up.residual(up);
    const float arrives = (1.0f - loss) * (1.0f - lost_up);
    // Two in a row may be one lost on the one way and one on the other.
    in_a_row = std::min(1.0f, in_a_row + up.in_a_row() + 2.0f * loss * lost_up);
    feedback.in_a_row = static_cast<std::uint16_t>(std::lround(in_a_row * 65535.0f));
    feedback.loss = static_cast<std::uint16_t>(std::lround((1.0f - arrives) * 65535.0f));
    const std::int64_t way_us = (round_trip + round_trip_of(session)).count_us();
    session.bears_losses =
        ReferencePolicy::bears_losses(1.0 - arrives, round_trip + round_trip_of(session), kFrame);
    feedback.round_trip =
        static_cast<std::uint16_t>(std::clamp<std::int64_t>(way_us / 100, 1, UINT16_MAX));
  }
  for (const std::uint8_t slot : session.slots) {
    ServerGuest& guest = room.guests[slot];
    if (guest.key_wanted &&
        (!guest.key_asked_at.is_set() || now - guest.key_asked_at >= kKeyFrameGap)) {
      guest.key_wanted = false;
      guest.key_asked_at = now;
      ++guest.key_frames;
      ++counters_.key_frames_asked;
      is_news = true;
    }
    const MonoTime again = guest.key_asked_at + kKeyFrameGap;
    if (guest.key_wanted) schedule_feedback(index, again, Duration(), kFeedbackGap);
    const wire::GuestFeedback about = feedback_about(index, slot, now);
    is_news = is_news || about != guest.told;
    guest.told = about;
    const bool pushed = feedback.guests.try_push(about);
    DANCE_ASSERT(pushed);
  }
  return is_news;
}

}  // namespace dance

#include "tunnel/server/signals/server_feedback.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/assert.h"
#include "tunnel/session/reference_control.h"

namespace dance {
namespace {

constexpr Duration kFeedbackGap = Duration::ms(4);
// To another server at these times, about its guests in all rooms at once.
constexpr Duration kRemoteFeedbackTurn = Duration::ms(20);
// To who may refer to what is lost as well: just so often that silence tells of a cut.
constexpr Duration kCleanFeedbackGap = Duration::ms(50);
// Poses of others come by to go along with; not worth a datagram of its own before.
constexpr Duration kWaitsForCompany = Duration::ms(20);
constexpr Duration kFrame = Duration::us(16'667);
// However many ask, and however often.
constexpr Duration kIntraFrameGap = Duration::ms(100);
// A link says something each 200 ms, and with each pose: a link that has not for this long is
// waited for no more.
constexpr Duration kStillHere = Duration::ms(500);
// A newcomer wants at once what was asked for it already, and its way is not known yet.
constexpr Duration kNewcomersWay = Duration::ms(100);
constexpr std::uint32_t kLongestRoundTrip_us = 1'000'000;

Duration round_trip_of(const ServerSession& session) {
  return Duration::us(std::min(session.newest_ping.round_trip_us, kLongestRoundTrip_us));
}

constexpr Duration kRoundTripUnit = Duration::us(100);

std::uint16_t in_units(Duration round_trip) {
  return static_cast<std::uint16_t>(
      std::clamp<std::int64_t>(round_trip.count_us() / kRoundTripUnit.count_us(), 0, UINT16_MAX));
}
std::uint16_t in_65536ths(float ratio) {
  return static_cast<std::uint16_t>(std::lround(ratio * 65535.0f));
}
float ratio_of(std::uint16_t in_65536ths) { return static_cast<float>(in_65536ths) / 65535.0f; }

MonoTime next_remote_turn(MonoTime now) {
  const std::int64_t turn_ns = kRemoteFeedbackTurn.count_ns();
  return MonoTime::from_ns((now.since_zero_ns() / turn_ns + 1) * turn_ns);
}

bool wants_any_of(const ServerSession& receiver, const ServerSession& sender) {
  return std::any_of(sender.slots.begin(), sender.slots.end(),
                     [&](std::uint8_t slot) { return receiver.filters[slot].wants_any(); });
}

}  // namespace

bool ServerFeedback::is_receiver(std::size_t member, std::size_t sender, MonoTime now) const {
  const ServerSession& session = server_.sessions[member];
  return member != sender && now - session.last_heard <= kStillHere;
}

void ServerFeedback::on_acks(std::size_t index, const wire::Acks& acks, MonoTime now) {
  ServerSession& session = server_.sessions[index];
  const ServerRoom& room = server_.rooms[session.room];
  const std::uint64_t before = session.stream.sent.acked();
  const bool is_good = session.stream.sent.acknowledge(acks, [&](const SentRing::Frame& frame) {
    const ServerGuest& guest = room.guests[frame.slot];
    if (!guest.in_use || guest.poses.stream() != frame.stream) return;
    session.filters[frame.slot].frames().add(frame.stream, frame.sequence);
    schedule(guest.owner, now);
  });
  server_.counters.datagrams_acked += session.stream.sent.acked() - before;
  // What is lost before a line that is too narrow is not mended by more bytes.
  if (session.pace.budget.is_limited())
    session.repeats_down = Repetition();
  else if (server_.limits.repeats)
    session.repeats_down.update(session.stream.sent.loss());
  if (!is_good) server_.reject(ServerReject::kBadAck);
}

void ServerFeedback::on_want(std::size_t index, std::uint8_t slot, MonoTime now) {
  ServerSession& session = server_.sessions[index];
  ServerGuest& guest = server_.rooms[session.room].guests[slot];
  if (!guest.in_use || guest.owner == index) return server_.reject(ServerReject::kForeignSlot);
  InterestFilter& filter = session.filters[slot];
  filter.frames().clear();
  // Who gets intra frames only has lost the first of them, or its proportions: the next
  // comes.
  if (filter.share() == Share::kIntra) {
    filter.await_intra(true);
    return;
  }
  // The one that was asked for last may be under way still.
  const bool is_known = session.newest_ping.round_trip_us != 0;
  const Duration way = (is_known ? round_trip_of(session) : kNewcomersWay) +
                       round_trip_of(server_.sessions[guest.owner]);
  if (guest.intra_asked_at.is_set() && now - guest.intra_asked_at < way) return;
  filter.await_intra(filter.share() == Share::kBase);
  want_intra_frame(guest, now);
}

void ServerFeedback::want_intra_frames_for(std::size_t newcomer, MonoTime now) {
  const ServerSession& session = server_.sessions[newcomer];
  for (std::size_t slot = 0; slot < session.filters.size(); ++slot) {
    ServerGuest& guest = server_.rooms[session.room].guests[slot];
    if (guest.in_use && guest.owner != newcomer && session.filters[slot].wants_any())
      want_intra_frame(guest, now);
  }
}

void ServerFeedback::want_intra_frame(ServerGuest& guest, MonoTime now) {
  ++server_.counters.intra_frames_wanted;
  guest.intra_wanted = true;
  ServerSession& owner = server_.sessions[guest.owner];
  const bool is_early =
      guest.intra_asked_at.is_set() && now - guest.intra_asked_at < kIntraFrameGap;
  const MonoTime at = is_early ? guest.intra_asked_at + kIntraFrameGap : now;
  schedule(guest.owner, at, Duration(), kFeedbackGap);
  if (!is_early && owner.feedback_due.is_set())
    owner.feedback_due = owner.feedback_alone = std::min(owner.feedback_due, now);
}

void ServerFeedback::repeat(std::size_t index, MonoTime now) {
  server_.sessions[index].feedback_is_repeat = true;
  if (!server_.sessions[index].feedback_due.is_set())
    schedule(index, now, kWaitsForCompany, kFeedbackGap);
}

void ServerFeedback::schedule(std::size_t index, MonoTime now) {
  const ServerSession& session = server_.sessions[index];
  if (session.is_remote())
    return schedule(index, next_remote_turn(now), Duration(), kRemoteFeedbackTurn / 2);
  schedule(index, now, kWaitsForCompany, session.tolerates_loss ? kCleanFeedbackGap : kFeedbackGap);
}

// Not before `at`, and not more often than senders can make use of; alone when it has waited so
// long.
void ServerFeedback::schedule(std::size_t index, MonoTime at, Duration waits, Duration gap) {
  ServerSession& session = server_.sessions[index];
  if (session.slots.empty()) return;
  // With nobody to receive there is nothing to tell.
  if (server_.rooms[session.room].members.size() < 2) return;
  if (session.feedback_made.is_set()) at = std::max(at, session.feedback_made + gap);
  if (!session.feedback_due.is_set()) {
    session.feedback_due = at;
    session.feedback_alone = at + waits;
    server_.reporting.push_back(index);
  }
  session.feedback_due = std::min(session.feedback_due, at);
  session.feedback_alone = std::min(session.feedback_alone, at + waits);
}

ReceiverSummary ServerFeedback::receivers_of(std::size_t index, std::uint8_t slot,
                                             MonoTime now) const {
  const ServerRoom& room = server_.rooms[server_.sessions[index].room];
  const ServerGuest& guest = room.guests[slot];
  ReceiverSummary receivers(guest.poses.has_any(), guest.poses.stream(), guest.poses.newest());
  for (const std::size_t member : room.members) {
    if (!is_receiver(member, index, now)) continue;
    const ServerSession& session = server_.sessions[member];
    // A server tells another of its own links only.
    if (session.is_remote() && server_.sessions[index].is_remote()) continue;
    if (session.is_remote())
      receivers.add(server_.remote_receivers[session.remote].frames[slot]);
    else
      receivers.add(session.filters[slot].divider(), session.filters[slot].frames());
  }
  return receivers;
}

wire::GuestFeedback ServerFeedback::about(std::size_t index, std::uint8_t slot,
                                          MonoTime now) const {
  const ServerGuest& guest = server_.rooms[server_.sessions[index].room].guests[slot];
  wire::GuestFeedback told;
  told.slot = slot;
  told.restarts = static_cast<std::uint8_t>(guest.poses.stream());
  told.intra_frames = guest.intra_frames;
  receivers_of(index, slot, now).fill(told);
  return told;
}

// From here to the worst receiver of what comes from this session.
PathFeedback ServerFeedback::path_of(std::size_t index, MonoTime now) const {
  const ServerSession& from = server_.sessions[index];
  float loss = 0.0f, in_a_row = 0.0f;
  Duration round_trip;
  PathFeedback path;
  for (const std::size_t member : server_.rooms[from.room].members) {
    const ServerSession& session = server_.sessions[member];
    if (!is_receiver(member, index, now) || (from.is_remote() && session.is_remote())) continue;
    if (session.is_remote()) {
      const PathFeedback& there = server_.remote_receivers[session.remote].path;
      if (!there.has_receiver) continue;
      path.has_receiver = true;
      loss = std::max(loss, ratio_of(there.loss));
      in_a_row = std::max(in_a_row, ratio_of(there.in_a_row));
      round_trip = std::max(round_trip, round_trip_of(session) + kRoundTripUnit * there.round_trip);
      continue;
    }
    if (!wants_any_of(session, from)) continue;
    path.has_receiver = true;
    const LossMeter& down = session.stream.sent.loss();
    loss = std::max(loss, session.repeats_down.residual(down));
    in_a_row = std::max(in_a_row, down.in_a_row());
    round_trip = std::max(round_trip, round_trip_of(session));
  }
  path.loss = in_65536ths(loss);
  path.in_a_row = in_65536ths(in_a_row);
  path.round_trip = in_units(round_trip);
  return path;
}

// True where one is asked for now; however many want it, and however often.
bool ServerFeedback::count_intra_frame(std::size_t index, ServerGuest& guest, MonoTime now) {
  bool is_asked = false;
  if (guest.intra_wanted &&
      (!guest.intra_asked_at.is_set() || now - guest.intra_asked_at >= kIntraFrameGap)) {
    guest.intra_wanted = false;
    guest.intra_asked_at = now;
    ++guest.intra_frames;
    ++server_.counters.intra_frames_asked;
    is_asked = true;
  }
  const MonoTime again = guest.intra_asked_at + kIntraFrameGap;
  if (guest.intra_wanted) schedule(index, again, Duration(), kFeedbackGap);
  return is_asked;
}

bool ServerFeedback::fill(std::size_t index, MonoTime now, wire::Feedback& feedback) {
  ServerSession& session = server_.sessions[index];
  ServerRoom& room = server_.rooms[session.room];
  session.feedback_due = session.feedback_alone = MonoTime();
  session.feedback_made = now;
  std::erase(server_.reporting, index);
  bool is_news = std::exchange(session.feedback_is_repeat, false);

  session.tolerates_loss = false;
  if (const PathFeedback down = path_of(index, now); down.has_receiver) {
    // What is lost on either way does not arrive.
    const LossMeter& up = session.stream.received.loss();
    if (server_.limits.repeats) session.repeats_up.update(up);
    feedback.wants_repeats = session.repeats_up.is_on();
    const float lost_up = session.repeats_up.residual(up);
    const float loss = ratio_of(down.loss);
    const float arrives = (1.0f - loss) * (1.0f - lost_up);
    // Two in a row may be one lost on the one way and one on the other.
    feedback.in_a_row = in_65536ths(
        std::min(1.0f, ratio_of(down.in_a_row) + up.in_a_row() + 2.0f * loss * lost_up));
    feedback.loss = in_65536ths(1.0f - arrives);
    const Duration way = kRoundTripUnit * down.round_trip + round_trip_of(session);
    session.tolerates_loss = ReferencePolicy::tolerates_loss(1.0 - arrives, way, kFrame);
    feedback.round_trip = std::max<std::uint16_t>(1, in_units(way));
  }
  for (const std::uint8_t slot : session.slots) {
    ServerGuest& guest = room.guests[slot];
    is_news = count_intra_frame(index, guest, now) || is_news;
    const wire::GuestFeedback news = about(index, slot, now);
    is_news = is_news || news != guest.told;
    guest.told = news;
    const bool pushed = feedback.guests.try_push(news);
    DANCE_ASSERT(pushed);
  }
  return is_news;
}

void ServerFeedback::tell_remote(std::size_t index, MonoTime now) {
  ServerSession& session = server_.sessions[index];
  ServerRoom& room = server_.rooms[session.room];
  session.feedback_due = session.feedback_alone = MonoTime();
  session.feedback_made = now;
  std::erase(server_.reporting, index);
  const bool is_repeat = std::exchange(session.feedback_is_repeat, false);
  RemoteFeedback feedback;
  feedback.path = path_of(index, now);
  for (const std::uint8_t slot : session.slots) {
    ServerGuest& guest = room.guests[slot];
    const bool is_asked = count_intra_frame(index, guest, now);
    const wire::GuestFeedback news = about(index, slot, now);
    if (!is_repeat && !is_asked && news == guest.told) continue;
    guest.told = news;
    feedback.intra_frames = guest.intra_frames;
    feedback.frames = receivers_of(index, slot, now).common();
    ++server_.remote_receivers[session.remote].meter.feedback_out;
    server_.cluster->on_feedback(server_.remote_receivers[session.remote].server, room, guest,
                                 feedback);
  }
}

void ServerFeedback::on_remote_feedback(std::size_t index, std::uint8_t slot,
                                        const RemoteFeedback& feedback, MonoTime now) {
  ServerSession& session = server_.sessions[index];
  ServerGuest& guest = server_.rooms[session.room].guests[slot];
  RemoteReceivers& there = server_.remote_receivers[session.remote];
  there.path = feedback.path;
  ++there.meter.feedback_in;
  const auto here = [&](const FrameWindow& frames) {
    const std::uint32_t stream = std::uint32_t{guest.generation} << 16 | (frames.stream() & 0xffff);
    return FrameWindow(stream, frames.newest(), frames.bits());
  };
  CommonFrames& frames = there.frames[slot];
  frames = feedback.frames;
  frames.full = here(frames.full);
  frames.base = here(frames.base);
  if (std::exchange(there.intra_frames[slot], feedback.intra_frames) != feedback.intra_frames)
    want_intra_frame(guest, now);
  schedule(guest.owner, now);
}

}  // namespace dance

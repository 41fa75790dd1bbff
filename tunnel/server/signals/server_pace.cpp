#include "tunnel/server/signals/server_pace.h"

#include <algorithm>

#include "core/net/datagram_sink.h"

namespace dance {
namespace {

constexpr Duration kSample = Duration::ms(500);
// A line is not judged by less; the first pings of a session come quickly.
constexpr Duration kShortestReport = Duration::ms(150);
constexpr std::uint64_t kFewestCounted = 20;  // datagrams, to tell a loss from
// A ramp becomes shorter slowly, as each step asks for an intra frame, and with room to spare.
constexpr Duration kEasesEach = Duration::s(1);
constexpr double kRoomToEase = 0.9;
// How much more, or less, than reckoned goes out; and how fast that is learnt, with each ping.
constexpr double kLeastMore = 0.5, kMostMore = 1.5, kFollows = 0.1;

}  // namespace

void ServerPace::sample(MonoTime now) {
  if (sampled_.is_set() && now - sampled_ < kSample) return;
  if (sampled_.is_set()) {
    const double seconds = (now - sampled_).as_seconds();
    for (ServerSession& session : server_.sessions) {
      if (!session.in_use) continue;
      session.voice.share.sample(seconds);
      for (const std::uint8_t slot : session.slots)
        server_.rooms[session.room].guests[slot].flow.sample(seconds);
    }
    records_per_s_ = static_cast<double>(server_.counters.records_out - records_out_) / seconds;
  }
  records_out_ = server_.counters.records_out;
  sampled_ = now;
}

void ServerPace::on_ping(std::size_t index, MonoTime now) {
  ServerSession& session = server_.sessions[index];
  SessionPace& pace = session.pace;
  const Duration passed = pace.reported.is_set() ? now - pace.reported : Duration();
  if (pace.reported.is_set() && passed < kShortestReport) return;
  const LossMeter& losses = session.stream.sent.loss();
  const std::uint64_t counted = losses.counted() - pace.counted;
  LineBudget::Report report;
  report.round_trip = Duration::us(session.newest_ping.round_trip_us);
  if (counted >= kFewestCounted)
    report.loss = static_cast<double>(losses.lost() - pace.lost) / static_cast<double>(counted);
  const auto bytes = session.meter.bytes_out - pace.bytes_out +
                     kIpUdp_bytes * (session.meter.datagrams_out - pace.datagrams_out);
  const auto of_voices = session.voice.bytes_out - pace.voice_bytes_out;
  const bool is_first = !pace.reported.is_set();
  if (!is_first) report.bytes_per_s = static_cast<double>(bytes) / passed.as_seconds();
  pace.reported = now;
  pace.bytes_out = session.meter.bytes_out;
  pace.voice_bytes_out = session.voice.bytes_out;
  pace.datagrams_out = session.meter.datagrams_out;
  if (is_first || counted >= kFewestCounted) {
    pace.lost = losses.lost();
    pace.counted = losses.counted();
  }
  if (is_first) return;
  const Wanted wanted = wanted_by(index);
  const double reckoned = share_cost(wanted.all(), pace.ramp, pace.window);
  const double of_poses =
      static_cast<double>(bytes - std::min(bytes, of_voices)) / passed.as_seconds();
  if (reckoned > 0.0)
    pace.costs_more +=
        kFollows * (std::clamp(of_poses / reckoned, kLeastMore, kMostMore) - pace.costs_more);
  const double all = share_cost(wanted.all(), 0, Duration());
  pace.budget.update(report, all + session.voice.share.wanted_bytes_per_s(), now);
  settle(index, wanted, now);
}

float ServerPace::distance_m2(const ServerSession& session, const ServerGuest& guest) const {
  const ServerRoom& room = server_.rooms[session.room];
  const auto square = [](float x) { return x * x; };
  // Who only listens stands in the middle.
  float least = square(guest.place.x_m) + square(guest.place.z_m);
  bool has_any = false;
  for (const std::uint8_t slot : session.slots) {
    const GuestPlace& own = room.guests[slot].place;
    const float distance = square(own.x_m - guest.place.x_m) + square(own.z_m - guest.place.z_m);
    least = has_any ? std::min(least, distance) : distance;
    has_any = true;
  }
  return least;
}

ServerPace::Wanted ServerPace::wanted_by(std::size_t index) const {
  const ServerSession& session = server_.sessions[index];
  const ServerRoom& room = server_.rooms[session.room];
  std::array<std::uint8_t, wire::kMaxGuestsPerRoom> dividers;
  dividers.fill(session.interest.default_divider);
  Wanted wanted;
  std::array<bool, wire::kMaxGuestsPerRoom> is_chosen{};
  for (const wire::InterestEntry& entry : session.interest.entries) {
    if (room.guests[entry.slot.slot].generation != entry.slot.generation) continue;
    dividers[entry.slot.slot] = entry.divider;
    is_chosen[entry.slot.slot] = entry.divider == 1;
  }
  const std::size_t first = session.slots.empty() ? 0 : session.slots[0];
  for (std::uint8_t slot = 0; slot < room.guests.size(); ++slot) {
    const ServerGuest& guest = room.guests[slot];
    if (!guest.in_use || guest.owner == index || dividers[slot] == 0) continue;
    wanted.ranks[wanted.count++] = {
        slot, is_chosen[slot], distance_m2(session, guest),
        static_cast<std::uint8_t>((slot + room.guests.size() - first) % room.guests.size())};
  }
  std::sort(wanted.ranks.begin(), wanted.ranks.begin() + static_cast<std::ptrdiff_t>(wanted.count),
            [](const Ranked& a, const Ranked& b) {
              if (a.is_chosen != b.is_chosen) return a.is_chosen;
              if (a.distance_m2 != b.distance_m2) return a.distance_m2 < b.distance_m2;
              return a.turn < b.turn;
            });
  for (std::size_t i = 0; i < wanted.count; ++i) {
    const std::uint8_t slot = wanted.ranks[i].slot;
    const PoseFlow& flow = room.guests[slot].flow;
    wanted.flows[i] = {flow.poses_per_s(), flow.bytes_per_s(), dividers[slot]};
  }
  return wanted;
}

void ServerPace::settle(std::size_t index, const Wanted& wanted, MonoTime now) {
  SessionPace& pace = server_.sessions[index].pace;
  // As the reckoning says it, which is about right.
  const double budget = pace.budget.bytes_per_second() / pace.costs_more;
  const std::size_t needed = ramp_for(wanted.all(), budget);
  const std::size_t before = std::min(pace.ramp, longest_ramp(wanted.count));
  pace.ramp = before;
  if (needed > before) {
    pace.ramp = needed;
    pace.eased = now;
  } else if (needed < before && now - pace.eased >= kEasesEach &&
             share_cost(wanted.all(), before - 1, kLongestShareWindow) <= kRoomToEase * budget) {
    pace.ramp = before - 1;
    pace.eased = now;
  }
  const Duration for_line =
      std::min(share_window_for(wanted.all(), pace.ramp, budget), kLongestShareWindow);
  const Duration for_server = share_window_for_company(
      wanted.all(), pace.ramp, records_per_s_ / server_.limits.eager_records_per_second);
  pace.window = std::max(for_line, for_server);
  // Poses first: voices get what these leave.
  const double cost = share_cost(wanted.all(), pace.ramp, pace.window);
  server_.sessions[index].voice.share.settle(pace.budget.is_limited(),
                                             (budget - cost) * pace.costs_more, now);
  std::array<std::uint8_t, wire::kMaxGuestsPerRoom> dividers;
  dividers.fill(1);
  for (std::size_t i = 0; i < wanted.count; ++i)
    dividers[wanted.ranks[i].slot] = ramp_divider(i, wanted.count, pace.ramp);
  if (dividers == pace.dividers) return;
  pace.dividers = dividers;
  interest_.settle(index, now);
}

}  // namespace dance

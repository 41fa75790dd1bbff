#include "tunnel/link/failover/server_choice.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace dance {
namespace {

// After this much of a lapse, which itself begins with 0.9 s of silence; a short cut is over by
// then.
constexpr Duration kStays = Duration::ms(200);
// A handshake takes three round trips, then the hello one, and something may be lost. Each round of
// all servers takes twice as long as the one before: what is slow is not torn off for ever.
constexpr Duration kShortestTry = Duration::ms(800);
constexpr std::int64_t kRoundTripsOfTry = 8;
constexpr Duration kLongestTry = Duration::s(20);
// A nearer server is nearer by so much at least: what is nearly equal stays as it is.
constexpr Duration kWorthwhile = Duration::ms(5);
constexpr std::int64_t kWorthwhileShare = 5;  // a fifth of the way

Duration distance_of(const std::vector<ServerChoice::Distance>& distances, const Address& server) {
  for (const auto& distance : distances)
    if (distance.server == server && distance.round_trip) return *distance.round_trip;
  return Duration::s(1000);
}

}  // namespace

bool ServerChoice::set_others(const wire::ServerList& others) {
  std::vector<Address> fresh;
  for (const Address& server : others)
    if (server != current_ && std::ranges::find(fresh, server) == fresh.end())
      fresh.push_back(server);
  const bool is_same =
      fresh.size() == others_.size() && std::ranges::all_of(fresh, [this](const Address& server) {
        return std::ranges::find(others_, server) != others_.end();
      });
  if (is_same) return false;
  others_ = std::move(fresh);
  return true;
}

std::vector<Address> ServerChoice::all() const {
  std::vector<Address> servers{current_};
  servers.insert(servers.end(), others_.begin(), others_.end());
  return servers;
}

std::optional<Address> ServerChoice::choose(const std::vector<Distance>& distances) {
  distances_ = distances;
  std::ranges::stable_sort(others_, std::less<>(),
                           [&](const Address& server) { return distance_of(distances, server); });
  if (others_.empty() || std::exchange(has_chosen_, true)) return std::nullopt;
  const Duration here = distance_of(distances, current_);
  const Duration there = distance_of(distances, others_.front());
  const Duration gain = here - there;
  if (gain < kWorthwhile || gain * kWorthwhileShare < here) return std::nullopt;
  return others_.front();
}

Duration ServerChoice::time_for(const Address& server) const {
  Duration time = kShortestTry;
  for (const Distance& distance : distances_)
    if (distance.server == server && distance.round_trip)
      time = std::max(time, *distance.round_trip * kRoundTripsOfTry);
  for (std::size_t round = tries_ / (others_.size() + 1); round > 0 && time < kLongestTry; --round)
    time = time * 2;
  return std::min(time, kLongestTry);
}

void ServerChoice::begin_try(MonoTime now) { trying_until_ = now + time_for(current_); }

bool ServerChoice::end_lapse() {
  lapsed_since_ = next_move_ = MonoTime();
  tries_ = 0;
  if (!std::exchange(has_moved_, false)) return false;
  has_chosen_ = false;
  return true;
}

std::optional<Address> ServerChoice::next(bool has_goodbye, MonoTime now) {
  if (!lapsed_since_.is_set()) {
    lapsed_since_ = now;
    next_move_ = std::max(has_goodbye ? now : now + kStays, trying_until_);
  }
  if (others_.empty()) {
    next_move_ = MonoTime();
    return std::nullopt;
  }
  if (now < next_move_) return std::nullopt;
  const Address server = others_.front();
  // Round and round: the one that was silent may come back.
  others_.erase(others_.begin());
  others_.push_back(current_);
  current_ = server;
  next_move_ = now + time_for(server);
  ++tries_;
  has_moved_ = true;
  return server;
}

}  // namespace dance

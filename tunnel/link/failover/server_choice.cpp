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
// all servers takes twice as long as the one before: a slow handshake is not cut off for ever.
constexpr Duration kShortestTry = Duration::ms(800);
constexpr std::int64_t kRoundTripsOfTry = 8;
constexpr Duration kLongestTry = Duration::s(20);
// Waiting time while no other server may be tried.
constexpr Duration kLookAgain = Duration::ms(200);
// The least gain that a move is worth: between servers that are nearly equal the link stays.
constexpr Duration kWorthwhile = Duration::ms(5);
constexpr std::int64_t kWorthwhileShare = 5;  // a fifth of the way

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

std::optional<Duration> ServerChoice::distance_of(const Address& server) const {
  const auto found = std::ranges::find(distances_, server, &Distance::server);
  return found == distances_.end() ? std::nullopt : found->round_trip;
}

void ServerChoice::set_distances(const std::vector<Distance>& distances) {
  std::vector<Distance> newest = distances;
  for (Distance& distance : newest)
    if (!distance.round_trip) distance.round_trip = distance_of(distance.server);
  distances_ = std::move(newest);
  std::ranges::stable_sort(others_, std::less<>(), [this](const Address& server) {
    return distance_of(server).value_or(Duration::s(1000));
  });
}

std::optional<Address> ServerChoice::choose() {
  if (others_.empty() || has_chosen_) return std::nullopt;
  const std::optional<Duration> here = distance_of(current_);
  const std::optional<Duration> there = distance_of(others_.front());
  if (!here || !there) return std::nullopt;  // the next round of probes may measure them
  has_chosen_ = true;
  const Duration gain = *here - *there;
  if (gain < kWorthwhile || gain * kWorthwhileShare < *here) return std::nullopt;
  return others_.front();
}

Duration ServerChoice::time_for(const Address& server) const {
  Duration time = kShortestTry;
  if (const auto distance = distance_of(server))
    time = std::max(time, *distance * kRoundTripsOfTry);
  for (std::size_t round = tries_ / (others_.size() + 1); round > 0 && time < kLongestTry; --round)
    time = time * 2;
  return std::min(time, kLongestTry);
}

// The server before it stays a choice: it is tried again after the others.
void ServerChoice::make_current(const Address& server) {
  std::erase(others_, server);
  if (current_ != server) others_.push_back(current_);
  current_ = server;
}

void ServerChoice::begin_try(const Address& server, MonoTime now) {
  make_current(server);
  trying_until_ = now + time_for(server);
}

bool ServerChoice::end_lapse() {
  lapsed_since_ = next_move_ = MonoTime();
  tries_ = 0;
  if (!std::exchange(has_moved_, false)) return false;
  has_chosen_ = false;
  return true;
}

std::optional<Address> ServerChoice::next(bool has_goodbye, ServerCandidates& candidates,
                                          MonoTime now) {
  if (!lapsed_since_.is_set()) {
    lapsed_since_ = now;
    next_move_ = std::max(has_goodbye ? now : now + kStays, trying_until_);
  }
  if (others_.empty()) {
    next_move_ = MonoTime();
    return std::nullopt;
  }
  if (now < next_move_) return std::nullopt;
  const auto allowed = std::ranges::find_if(
      others_, [&](const Address& other) { return candidates.take_try(other, now); });
  if (allowed == others_.end()) {
    next_move_ = now + kLookAgain;
    return std::nullopt;
  }
  const Address server = *allowed;
  make_current(server);
  next_move_ = now + time_for(server);
  ++tries_;
  has_moved_ = true;
  return server;
}

}  // namespace dance

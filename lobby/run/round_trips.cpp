#include "lobby/run/round_trips.h"

#include <algorithm>
#include <utility>

#include "core/net/address.h"
#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "tunnel/link/failover/server_probe.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

constexpr Duration kLook = Duration::ms(20);
constexpr Duration kLongestRound = Duration::s(3);

}  // namespace

RoundTrips::RoundTrips(std::function<void()> has_answers) : has_answers_(std::move(has_answers)) {}

RoundTrips::~RoundTrips() {
  is_ended_.store(true, std::memory_order_release);
  finish();
}

void RoundTrips::finish() {
  if (thread_.joinable()) thread_.join();
}

void RoundTrips::ask(std::vector<std::string> servers) {
  if (servers.size() > WindowChoices::kMostRooms) servers.resize(WindowChoices::kMostRooms);
  ++round_;
  if (is_busy_.load(std::memory_order_acquire)) {
    next_ = std::move(servers);
    has_next_ = true;
    return;
  }
  finish();
  has_next_ = false;
  if (servers.empty()) return;
  is_busy_.store(true, std::memory_order_release);
  thread_ = std::thread([this, servers = std::move(servers), round = round_]() mutable {
    answer(std::move(servers), round);
    is_busy_.store(false, std::memory_order_release);
    if (!is_ended_.load(std::memory_order_acquire)) has_answers_();
  });
}

const RoundTrips::Answers* RoundTrips::take() {
  if (has_next_ && !is_busy_.load(std::memory_order_acquire)) {
    --round_;
    ask(std::exchange(next_, {}));
  }
  const Answers* answers = answers_.take();
  return answers != nullptr && answers->round == round_ ? answers : nullptr;
}

void RoundTrips::answer(std::vector<std::string> servers, std::uint32_t round) {
  Answers answers;
  answers.round = round;
  answers.count = servers.size();
  std::vector<Address> asked;
  std::array<Address, WindowChoices::kMostRooms> of;
  for (std::size_t i = 0; i < servers.size() && !is_ended_.load(std::memory_order_acquire); ++i) {
    const auto found = Address::resolve(servers[i], kDefaultServerPort);
    if (!found) continue;
    of[i] = *found;
    if (std::ranges::find(asked, *found) == asked.end()) asked.push_back(*found);
  }
  if (auto poller = Poller::create(); poller && !asked.empty()) {
    ServerProbe probe(**poller);
    const MonoTime until = mono_now() + kLongestRound;
    probe.begin(asked, mono_now());
    while (!probe.is_done() && mono_now() < until && !is_ended_.load(std::memory_order_acquire)) {
      probe.tick(mono_now());
      (*poller)->run_once(kLook);
    }
    for (std::size_t i = 0; i < servers.size(); ++i) {
      const auto round_trip = probe.round_trip(of[i]);
      answers.answered[i] = of[i].is_set() && round_trip.has_value();
      if (answers.answered[i]) answers.round_trips[i] = *round_trip;
    }
  }
  answers_.put(answers);
}

}  // namespace dance

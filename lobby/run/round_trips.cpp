#include "lobby/run/round_trips.h"

#include <algorithm>
#include <utility>

#include "core/net/address.h"
#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "house/session.h"
#include "tunnel/link/failover/server_probe.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

constexpr Duration kLook = Duration::ms(20);
constexpr Duration kLongestRound = Duration::s(3);
constexpr Duration kLongestQuestion = Duration::s(2);

}  // namespace

RoundTrips::RoundTrips(std::function<void()> has_answers) : has_answers_(std::move(has_answers)) {}

RoundTrips::~RoundTrips() {
  is_ended_.store(true, std::memory_order_release);
  finish();
}

void RoundTrips::finish() {
  if (thread_.joinable()) thread_.join();
}

void RoundTrips::ask(Question question) {
  if (question.rooms.size() > WindowChoices::kMostRooms)
    question.rooms.resize(WindowChoices::kMostRooms);
  ++round_;
  if (is_busy_.load(std::memory_order_acquire)) {
    next_ = std::move(question);
    has_next_ = true;
    return;
  }
  finish();
  has_next_ = false;
  if (question.rooms.empty()) return;
  is_busy_.store(true, std::memory_order_release);
  thread_ = std::thread([this, question = std::move(question), round = round_] {
    answer(question, round);
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

void RoundTrips::answer(const Question& question, std::uint32_t round) {
  Answers answers;
  answers.round = round;
  answers.count = question.rooms.size();
  std::array<Address, WindowChoices::kMostRooms> of;
  for (std::size_t i = 0; i < answers.count && !is_ended_.load(std::memory_order_acquire); ++i)
    if (const auto found = Address::resolve(question.rooms[i].server, kDefaultServerPort))
      of[i] = *found;
  const std::span servers(of.data(), answers.count);
  measure(servers, answers);
  answers_.put(answers);  // before what takes longer
  if (!is_ended_.load(std::memory_order_acquire)) has_answers_();
  ask_guests(question, servers, answers);
  answers_.put(answers);
}

void RoundTrips::measure(std::span<const Address> servers, Answers& answers) const {
  std::vector<Address> asked;
  for (const Address& server : servers)
    if (server.is_set() && std::ranges::find(asked, server) == asked.end()) asked.push_back(server);
  auto poller = Poller::create();
  if (!poller || asked.empty()) return;
  ServerProbe probe(**poller);
  const MonoTime until = mono_now() + kLongestRound;
  probe.begin(asked, mono_now());
  while (!probe.is_done() && mono_now() < until && !is_ended_.load(std::memory_order_acquire)) {
    probe.tick(mono_now());
    (*poller)->run_once(kLook);
  }
  for (std::size_t i = 0; i < servers.size(); ++i) {
    const auto round_trip = probe.round_trip(servers[i]);
    answers.answered[i] = servers[i].is_set() && round_trip.has_value();
    if (answers.answered[i]) answers.round_trips[i] = *round_trip;
  }
}

// With one key one handshake, however many rooms it opens.
void RoundTrips::ask_guests(const Question& question, std::span<const Address> servers,
                            Answers& answers) const {
  LinkKeySource source;
  if (const auto house = load_session(question.settings)) {
    source.key_file = house->key_file;
    source.certificates = {house->certificate, house->private_key, house->authorities};
  }
  struct Asked {
    Address server;
    LinkKey key;
    std::vector<std::size_t> places;
    std::vector<wire::RoomName> rooms;
  };
  std::vector<Asked> all;
  for (std::size_t i = 0; i < servers.size(); ++i) {
    const auto room = wire::RoomName::parse(question.rooms[i].room);
    if (!answers.answered[i] || !room) continue;
    auto key = choose_link_key(question.rooms[i].server, *room, question.guest, source);
    if (!key) {
      answers.guests[i].state = RoomGuests::State::kNotAllowed;
      continue;
    }
    auto known = std::ranges::find_if(all, [&](const Asked& asked) {
      return asked.server == servers[i] && asked.key.name == key->name;
    });
    if (known == all.end()) known = all.insert(all.end(), {servers[i], std::move(*key), {}, {}});
    known->places.push_back(i);
    known->rooms.push_back(*room);
  }
  for (const Asked& asked : all) {
    const auto found =
        ask_who_is_there(asked.server, asked.key, asked.rooms, kLongestQuestion, is_ended_);
    for (std::size_t i = 0; i < found.size(); ++i) answers.guests[asked.places[i]] = found[i];
  }
}

}  // namespace dance

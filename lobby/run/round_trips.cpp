#include "lobby/run/round_trips.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/net/address.h"
#include "core/net/mono_clock.h"
#include "core/net/poller.h"
#include "house/session.h"
#include "tunnel/link/failover/server_probe.h"
#include "tunnel/seal/keys/house_keys.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

constexpr Duration kLook = Duration::ms(20);
constexpr Duration kLongestRound = Duration::s(3);
constexpr Duration kLongestQuestion = Duration::s(2);
// Servers that are found wait so long for names that are looked up.
constexpr Duration kLongestLookUp = Duration::s(1);

using Server = RoundTrips::Answer::Server;

// 192.0.2.7 and 2001:db8::7 are not.
bool is_looked_up(const std::string& server) {
  const std::string host = host_of(server);
  return host.find(':') == std::string::npos &&
         host.find_first_not_of("0123456789.") != std::string::npos;
}

// One question in the thread.
class AskedRooms {
 public:
  AskedRooms(const RoundTrips::Question& question, RoundTrips::Answers& answers,
             const std::function<void()>& tell, const std::atomic<bool>& stops)
      : question_(question), answers_(answers), tell_(tell), stops_(stops) {
    for (const KnownRoom& room : question.rooms) answers_.rooms.push_back({room, {}, {}, {}, {}});
    if (const auto house = load_session(question.settings)) {
      keys_.key_file = house->key_file;
      keys_.certificates = {house->certificate, house->private_key, house->authorities};
    }
  }
  void run();

 private:
  struct Place {
    std::string name;
    Address address;
    std::vector<std::size_t> rooms;
  };
  // Rooms that one key opens.
  struct Asked {
    LinkKey key;
    std::vector<std::size_t> places;
    std::vector<wire::RoomName> rooms;
  };
  bool has_stopped() const { return stops_.load(std::memory_order_acquire); }
  std::vector<Place> servers() const;
  void ask(std::span<const Place> found);
  void ask_guests(const Place& server);

  const RoundTrips::Question& question_;
  RoundTrips::Answers& answers_;
  const std::function<void()>& tell_;
  const std::atomic<bool>& stops_;
  LinkKeySource keys_;
};

// Those whose names need no look-up come first.
std::vector<AskedRooms::Place> AskedRooms::servers() const {
  std::vector<Place> all;
  for (std::size_t i = 0; i < question_.rooms.size(); ++i) {
    const std::string& name = question_.rooms[i].server;
    auto known = std::ranges::find(all, name, &Place::name);
    if (known == all.end()) known = all.insert(all.end(), {name, {}, {}});
    known->rooms.push_back(i);
  }
  std::stable_partition(all.begin(), all.end(),
                        [](const Place& server) { return !is_looked_up(server.name); });
  return all;
}

void AskedRooms::run() {
  const std::vector<Place> all = servers();
  std::vector<Place> found;
  MonoTime begin = mono_now();
  for (std::size_t i = 0; i < all.size() && !has_stopped(); ++i) {
    const bool begins_look_ups =
        i > 0 && is_looked_up(all[i].name) && !is_looked_up(all[i - 1].name);
    if (begins_look_ups || mono_now() - begin > kLongestLookUp) {
      ask(std::exchange(found, {}));
      begin = mono_now();
    }
    if (const auto address = Address::resolve(all[i].name, kDefaultServerPort)) {
      found.push_back(all[i]);
      found.back().address = *address;
      continue;
    }
    for (const std::size_t room : all[i].rooms) answers_.rooms[room].server = Server::kSilent;
    if (!has_stopped()) tell_();
  }
  ask(found);
}

void AskedRooms::ask(std::span<const Place> found) {
  std::vector<Address> addresses;
  for (const Place& server : found)
    if (std::ranges::find(addresses, server.address) == addresses.end())
      addresses.push_back(server.address);
  auto poller = Poller::create();
  if (!poller || addresses.empty()) return;
  ServerProbe probe(**poller, [](const Address&) {});
  const MonoTime until = mono_now() + kLongestRound;
  probe.begin(addresses, mono_now());
  while (!probe.is_done() && mono_now() < until && !has_stopped()) {
    probe.tick(mono_now());
    (*poller)->run_once(kLook);
  }
  if (has_stopped()) return;
  for (const Place& server : found) {
    const auto round_trip = probe.round_trip(server.address);
    for (const std::size_t i : server.rooms) {
      answers_.rooms[i].server = round_trip ? Server::kAnswers : Server::kSilent;
      if (round_trip) answers_.rooms[i].round_trip = *round_trip;
    }
  }
  tell_();  // before what takes longer
  for (const Place& server : found) {
    if (!probe.round_trip(server.address)) continue;
    ask_guests(server);
    if (has_stopped()) return;
    tell_();
  }
}

// With one key one handshake, however many rooms it opens.
void AskedRooms::ask_guests(const Place& server) {
  std::vector<Asked> all;
  for (const std::size_t i : server.rooms) {
    RoomGuests& guests = answers_.rooms[i].guests;
    answers_.rooms[i].told = mono_now();
    const auto room = wire::RoomName::parse(question_.rooms[i].room);
    if (!room) continue;
    auto key = find_link_key(server.name, server.address, *room, question_.guest, keys_);
    if (!key || !*key) {
      guests.state = key ? RoomGuests::State::kNoKey : RoomGuests::State::kRefused;
      continue;
    }
    // Rooms that one key opens share a session.
    auto known = std::ranges::find_if(all, [&](const Asked& to) {
      return to.key.identity == (*key)->identity && to.key.key == (*key)->key;
    });
    if (known == all.end()) known = all.insert(all.end(), {std::move(**key), {}, {}});
    known->places.push_back(i);
    known->rooms.push_back(*room);
  }
  for (const Asked& asked : all) {
    const auto found =
        ask_who_is_there(server.address, asked.key, asked.rooms, kLongestQuestion, stops_);
    for (std::size_t i = 0; i < found.size(); ++i) {
      RoundTrips::Answer& answer = answers_.rooms[asked.places[i]];
      answer.guests = found[i];
      answer.told = mono_now();
    }
  }
}

}  // namespace

RoundTrips::RoundTrips(std::function<void()> has_answers) : has_answers_(std::move(has_answers)) {}

RoundTrips::~RoundTrips() {
  is_ended_.store(true, std::memory_order_release);
  stops_.store(true, std::memory_order_release);
  finish();
}

void RoundTrips::finish() {
  if (thread_.joinable()) thread_.join();
}

void RoundTrips::ask(Question question) {
  if (question.rooms.size() > WindowChoices::kMostRooms)
    question.rooms.resize(WindowChoices::kMostRooms);
  ++round_;
  if (is_asking_.load(std::memory_order_acquire)) {
    stops_.store(true, std::memory_order_release);
    next_ = std::move(question);
    has_next_ = true;
    return;
  }
  start(std::move(question));
}

void RoundTrips::start(Question question) {
  finish();
  has_next_ = false;
  if (question.rooms.empty()) return;
  stops_.store(false, std::memory_order_release);
  is_asking_.store(true, std::memory_order_release);
  thread_ = std::thread([this, question = std::move(question), round = round_] {
    Answers answers;
    answers.round = round;
    const std::function<void()> tell = [&] {
      answers_.put(answers);
      has_answers_();
    };
    AskedRooms(question, answers, tell, stops_).run();
    is_asking_.store(false, std::memory_order_release);
    if (!is_ended_.load(std::memory_order_acquire)) has_answers_();
  });
}

const RoundTrips::Answers* RoundTrips::take() {
  if (has_next_ && !is_asking_.load(std::memory_order_acquire)) start(std::exchange(next_, {}));
  const Answers* answers = answers_.take();
  return answers != nullptr && answers->round == round_ ? answers : nullptr;
}

}  // namespace dance

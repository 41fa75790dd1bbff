// Attacks that take other guests' share of a server, with the built dance-server and dance-link.
// Each test makes a network namespace of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>

#include "core/net/mono_clock.h"
#include "core/program/child_process.h"
#include "testing/flood/newcomer_flood.h"
#include "testing/line/lossy_proxy.h"
#include "testing/private_network.h"
#include "tests/apps/run_program.h"
#include "tests/test_folder.h"
#include "tests/tunnel/cluster/listing_server.h"
#include "tests/tunnel/seal/guest_key.h"
#include "tests/tunnel/voice/voices.h"
#include "tunnel/link/link.h"
#include "tunnel/seal/keys/house_keys.h"
#include "tunnel/seal/keys/key_files.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

constexpr std::uint16_t kFairnessPort = 7451;
const std::string kFairnessPortText = std::to_string(kFairnessPort);

// A house with a link of its own, in this process.
struct FairHouse {
  std::unique_ptr<Link> link;
  bool is_refused = false;
  std::map<std::string, std::uint64_t> voices;
};

class Fairness : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto entered = enter_private_network();
    if (!entered) GTEST_SKIP() << entered.error().what;
    auto made = Poller::create();
    ASSERT_TRUE(made) << made.error().what;
    poller_ = std::move(*made);
    keys_ = folder_.path("keys");
  }
  void TearDown() override {
    houses_.clear();
    server_.reset();
  }

  // A key for one guest, which the server reads at its start.
  LinkKey new_guest(const std::string& name) {
    const Finished made = run(bin("dance-server") + " --keys " + keys_ + " --new-guest " + name +
                              " --address 127.0.0.1");
    EXPECT_EQ(made.exit_code, 0) << made.talk;
    const auto line = HouseKey::parse(made.output);
    EXPECT_TRUE(line) << made.output;
    return line ? *LinkKey::of(*line, PrivateKey::make()) : LinkKey();
  }

  void start_server() {
    auto started =
        ChildProcess::start({bin("dance-server"),
                             {"--bind", "::", "--port", kFairnessPortText, "--keys", keys_},
                             folder_.path("output"),
                             folder_.path("talk")});
    ASSERT_TRUE(started) << started.error().what;
    server_.emplace(std::move(*started));
    const auto is_up = [&] {
      return text_of(folder_.path("talk")).find("hears on") != std::string::npos;
    };
    ASSERT_TRUE(wait_for(is_up)) << text_of(folder_.path("talk"));
  }

  FairHouse& open_house(const LinkKey& key, const std::string& room,
                        const std::vector<std::string>& guests,
                        const Address& server = Address::loopback(kFairnessPort)) {
    FairHouse& house = *houses_.emplace_back(std::make_unique<FairHouse>());
    LinkOptions options;
    options.room = guest(room);
    for (const std::string& name : guests) EXPECT_TRUE(options.guests.try_push(guest(name)));
    LinkHandlers handlers;
    handlers.on_refused = [&house](const wire::RefusalNotice&, MonoTime) {
      house.is_refused = true;
    };
    handlers.on_voice = [&house](const GuestId& who, const Voice&, MonoTime) {
      ++house.voices[std::string(who.view())];
    };
    auto opened = Link::open({server}, key, options, std::move(handlers), *poller_);
    EXPECT_TRUE(opened) << opened.error().what;
    house.link = std::move(*opened);
    return house;
  }

  // Turns until it is so; the time only ends a test that has failed.
  template <class Condition>
  bool turn_until(const Condition& is_so, Duration longest = Duration::s(60)) {
    const MonoTime given_up = mono_now() + longest;
    for (; !is_so() && mono_now() < given_up;) poller_->run_once(Duration::ms(5));
    return is_so();
  }
  void turn(Duration duration) {
    turn_until([] { return false; }, duration);
  }

  // 3,000 hellos a second. Guests far away, 500 ms there and back, come in one after the other,
  // each from a network of its own.
  void expect_newcomers_come_in(int network_bits) {
    for (const std::string& route :
         {"-6 route add local " + std::string(NewcomerFlood::kPrefix) + " dev lo",
          std::string("-4 route add local 10.0.0.0/8 dev lo")})
      ASSERT_EQ(run("ip " + route).exit_code, 0);
    const LinkKey alice = new_guest("alice");
    start_server();
    NewcomerFlood::Options attack;
    attack.server = *Address::resolve("[::1]:" + kFairnessPortText);
    attack.network_bits = network_bits;
    auto flood = NewcomerFlood::make(attack);
    ASSERT_TRUE(flood) << flood.error().what;
    (*flood)->start();
    // The flood has then used up the burst of handshakes that the server allows.
    ASSERT_TRUE(turn_until([&] { return (*flood)->totals().begun > 6000; }));
    for (int i = 0; i < 4; ++i) {
      // The source of a datagram to a local address is that address.
      const Address server =
          *Address::resolve("10." + std::to_string(i + 1) + ".0.1:" + kFairnessPortText);
      LossyLine far;
      far.up.spec.delay = far.down.spec.delay = Duration::ms(250);
      auto line = LossyProxy::open(Address::loopback(0), server, far, *poller_);
      ASSERT_TRUE(line) << line.error().what;
      FairHouse& house = open_house(alice, "salsa", {"alice"}, (*line)->local_address());
      EXPECT_TRUE(turn_until([&] { return house.link->is_connected(); })) << "newcomer " << i;
      // Counted in tries, as machines differ in speed. Before, nobody came in at all.
      EXPECT_LE(house.link->seal_counters().tries, 3u) << "newcomer " << i;
      houses_.clear();
    }
    EXPECT_GT((*flood)->totals().handshakes, 400u) << "the attacker gets its share too";
  }

  TestFolder folder_{"fairness"};
  std::string keys_;
  std::unique_ptr<Poller> poller_;
  std::optional<ChildProcess> server_;
  std::deque<std::unique_ptr<FairHouse>> houses_;
};

TEST_F(Fairness, NewcomersComeInDuringAFloodFromOneIpv6Slash56) { expect_newcomers_come_in(8); }
TEST_F(Fairness, NewcomersComeInDuringAFloodFrom65536Ipv6Slash64s) { expect_newcomers_come_in(16); }

TEST_F(Fairness, OneGuestsKeyLeavesTheServersPlacesToOthers) {
  const LinkKey mallory = new_guest("mallory"), alice = new_guest("alice");
  start_server();
  for (int i = 0; i < 280; ++i) open_house(mallory, "m" + std::to_string(i % 70), {});
  const auto settled = [&] {
    return std::ranges::all_of(houses_, [](const auto& house) {
      return house->link->is_connected() || house->is_refused ||
             house->link->seal_counters().tries > 1;
    });
  };
  EXPECT_TRUE(turn_until(settled));
  FairHouse& house = open_house(alice, "salsa", {"alice"});
  EXPECT_TRUE(turn_until([&] { return house.link->is_connected(); }));
  EXPECT_FALSE(house.is_refused);
  const auto of_mallory =
      std::ranges::count_if(houses_, [](const auto& it) { return it->link->is_connected(); });
  EXPECT_LE(of_mallory - 1, 8);
}

TEST_F(Fairness, OneGuestsKeyLeavesARoomsPlacesToOthers) {
  const LinkKey mallory = new_guest("mallory"), alice = new_guest("alice");
  start_server();
  for (int i = 0; i < 8; ++i) {
    std::vector<std::string> names;
    for (int k = 0; k < 16; ++k) names.push_back("mallory-" + std::to_string(16 * i + k));
    open_house(mallory, "salsa", names);
  }
  const auto settled = [&] {
    return std::ranges::all_of(houses_, [](const auto& house) {
      return house->link->is_connected() || house->is_refused;
    });
  };
  EXPECT_TRUE(turn_until(settled));
  const auto of_mallory =
      std::ranges::count_if(houses_, [](const auto& it) { return it->link->is_connected(); });
  EXPECT_EQ(of_mallory, 1) << "16 guests";
  FairHouse& house = open_house(alice, "salsa", {"alice"});
  EXPECT_TRUE(turn_until([&] { return house.link->is_connected(); }));
  EXPECT_FALSE(house.is_refused);
}

TEST_F(Fairness, EightLoudGuestsOfOneLinkLeaveAnHonestTalkerHerPlace) {
  const LinkKey mallory = new_guest("mallory"), alice = new_guest("alice"), bob = new_guest("bob");
  start_server();
  std::vector<std::string> loud;
  for (int i = 0; i < 8; ++i) loud.push_back("mallory-" + std::to_string(i));
  FairHouse& attacker = open_house(mallory, "salsa", loud);
  FairHouse& talker = open_house(alice, "salsa", {"alice"});
  FairHouse& listener = open_house(bob, "salsa", {"bob"});
  const auto connected = [&] {
    return std::ranges::all_of(houses_, [](const auto& it) { return it->link->is_connected(); });
  };
  ASSERT_TRUE(turn_until(connected));
  std::uint32_t sequence = 1;
  const auto speak = [&](bool with_alice) {
    const MonoTime now = mono_now();
    Voice voice = voice_number(sequence++, now - Duration::ms(10), this_clock_id());
    voice.level_dbfs = 0;
    for (const std::string& name : loud) attacker.link->send(guest(name), voice, now);
    voice.level_dbfs = -40;
    if (with_alice) talker.link->send(guest("alice"), voice, now);
    turn(Duration::ms(10));
  };
  for (int i = 0; i < 100; ++i) speak(false);
  for (int i = 0; i < 200; ++i) speak(true);
  turn(Duration::ms(200));
  // A packet may be late; before, she had none at all.
  EXPECT_GT(listener.voices["alice"], 150u);
  std::uint64_t of_mallory = 0;
  for (const std::string& name : loud) of_mallory += listener.voices[name];
  EXPECT_LE(of_mallory, 310u) << "one place, however many guests";
}

// A server that lies: each moment it lists other ports of a third host as its cluster.
TEST_F(Fairness, ALyingServerCannotAimALinkAtAThirdHost) {
  // Public addresses of documentation, on this namespace's loopback device.
  for (const char* host : {"203.0.113.5", "198.51.100.7", "192.168.77.7"})
    ASSERT_EQ(run("ip addr add " + std::string(host) + "/32 dev lo").exit_code, 0);
  const GuestKey key = key_of("alice");
  const PrivateKey identity = PrivateKey::make();
  const Address at = *Address::resolve("203.0.113.5:" + kFairnessPortText);
  KeyRing ring;
  ASSERT_TRUE(ring.add(key));
  ListingServer liar(at, identity, std::make_shared<const KeyRing>(std::move(ring)), *poller_);
  // The third host, and one in the guest's own network.
  constexpr std::uint16_t kFirst = 20'000, kPorts = 1000;
  std::vector<UdpSocket> victims;
  const auto bind_victim = [&](const char* host, std::uint16_t port) {
    auto socket = UdpSocket::bind(Address::resolve(host, port).value(), {8, 256});
    ASSERT_TRUE(socket) << socket.error().what;
    victims.push_back(std::move(*socket));
  };
  for (std::uint16_t i = 0; i < kPorts; ++i) bind_victim("198.51.100.7", kFirst + i);
  bind_victim("192.168.77.7", kFirst);

  const HouseKey own{key.name, at.to_string(), {}, identity.public_key(), key.own};
  ASSERT_TRUE(write_secret(folder_.path("link-keys"), own.line() + "\n"));
  auto link = ChildProcess::start(
      {bin("dance-link"),
       {"--server", at.to_string(), "--guest", "alice", "--key-file", folder_.path("link-keys")},
       folder_.path("output"),
       folder_.path("link-talk")});
  ASSERT_TRUE(link) << link.error().what;
  const auto has_session = [&] {
    liar.tick(mono_now());
    return liar.sessions() == 1;
  };
  ASSERT_TRUE(turn_until(has_session)) << text_of(folder_.path("link-talk"));

  std::uint16_t next = 0;
  MonoTime change;
  const MonoTime end = mono_now() + Duration::s(7);
  turn_until([&] {
    if (mono_now() >= change) {
      wire::ServerList named;
      (void)named.try_push(*Address::resolve("192.168.77.7:" + std::to_string(kFirst)));
      while (!named.is_full()) {
        (void)named.try_push(
            *Address::resolve("198.51.100.7:" + std::to_string(kFirst + next++ % kPorts)));
      }
      liar.list(named);
      change = mono_now() + Duration::ms(100);
    }
    liar.tick(mono_now());
    return mono_now() >= end;
  });
  EXPECT_FALSE(link->has_ended()) << text_of(folder_.path("link-talk"));
  std::uint64_t datagrams = 0;
  std::size_t ports = 0, of_private = 0;
  for (std::size_t i = 0; i < victims.size(); ++i) {
    victims[i].receive();
    const std::uint64_t received = victims[i].counters().received;
    datagrams += received;
    ports += received > 0 ? 1 : 0;
    if (i == kPorts) of_private = received;
  }
  EXPECT_GE(datagrams, 1u) << "the lists reached the link";
  EXPECT_LE(datagrams, 4u);
  EXPECT_LE(ports, 2u);
  EXPECT_EQ(of_private, 0u) << "a public server named a host of the guest's own network";
}

}  // namespace
}  // namespace dance

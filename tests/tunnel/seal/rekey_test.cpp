// A session gets new keys while it is in use: nothing is lost, and nobody else can take part.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <vector>

#include "tests/tunnel/seal/sealed_street.h"

namespace dance {
namespace {

// One house that exchanges datagrams with the server every 5 ms, both ways.
class Rekeying : public ::testing::Test {
 protected:
  explicit Rekeying(RekeyLimits limits = {Duration::s(1), 1u << 26}) {
    house->client->set_rekey_limits(limits);
    street.run(Duration::ms(300));
    EXPECT_EQ(house->sealed, 1);
  }

  void talk(Duration duration) {
    for (const MonoTime end = street.now + duration; street.now < end;) {
      street.say(*house, "up " + std::to_string(said_));
      if (!street.heard.empty())
        street.answer(street.heard[0].peer, "down " + std::to_string(said_));
      ++said_;
      street.run(Duration::ms(5));
    }
  }
  std::size_t received_up() const {
    std::set<std::string> texts;
    for (const auto& it : street.heard) texts.insert(it.text);
    return texts.size();
  }
  std::size_t received_down() const {
    return std::set(house->heard.begin(), house->heard.end()).size();
  }
  // Ids of the sessions in which data was sent to the server.
  std::set<std::uint64_t> ids_used() const {
    std::set<std::uint64_t> ids;
    for (const auto& passing : street.sent) {
      const auto opening = seal::parse(passing.bytes);
      if (opening && opening->form == seal::Form::kCompact) ids.insert(opening->id);
    }
    return ids;
  }
  std::uint64_t rekeyings() const { return street.server->counters().rekeyings; }

  const GuestKey key = key_of("alice");
  SealedStreet street{{key}};
  SealedStreet::House* house = &street.add_house("alice", key.own);
  int said_ = 0;
};

TEST_F(Rekeying, ChangesTheKeysAgainAndAgainAndLosesNothing) {
  talk(Duration::s(10));
  street.run(Duration::ms(100));
  EXPECT_GE(rekeyings(), 5u);
  EXPECT_EQ(house->client->counters().rekeyings, rekeyings());
  EXPECT_GE(ids_used().size(), 6u) << "each session has an id and keys of its own";
  EXPECT_EQ(received_up(), static_cast<std::size_t>(said_));
  // The server learns of the house by its first datagram: the first answer goes out after that.
  EXPECT_GE(received_down(), static_cast<std::size_t>(said_ - 1));
  EXPECT_EQ(house->sealed, 1) << "the link above the seal notices nothing";
  EXPECT_TRUE(house->troubles.empty());
  for (const auto& heard : street.heard) EXPECT_EQ(heard.peer, street.heard[0].peer);
  EXPECT_EQ(std::ranges::count(street.ended, street.heard[0].peer), 0);
  EXPECT_EQ(street.server->peer_count(), 1u) << "no session is left over";
  EXPECT_EQ(street.server->counters().of(SealReject::kUnknownId), 0u);
  EXPECT_EQ(street.server->counters().of(SealReject::kForged), 0u);
}

class RekeyingByCount : public Rekeying {
 protected:
  RekeyingByCount() : Rekeying({Duration::s(3600), 200}) {}
};

TEST_F(RekeyingByCount, ChangesTheKeysAfterTheRecordLimit) {
  talk(Duration::s(4));  // 800 datagrams
  EXPECT_GE(rekeyings(), 3u);
  EXPECT_LE(rekeyings(), 4u);
}

// OpenSSL's timers are real, and time here is not: a handshake that loses a datagram ends, and the
// next begins a minute later.
TEST_F(Rekeying, GoesOnWhereDatagramsAreLost) {
  Random chance(3);
  street.on_passing = [&](SealedStreet::Passing&) { return chance.next_u64() % 50 != 0; };
  talk(Duration::s(240));
  EXPECT_GE(rekeyings(), 2u);
  EXPECT_EQ(house->sealed, 1);
  EXPECT_TRUE(house->troubles.empty());
  EXPECT_GE(received_up(), static_cast<std::size_t>(said_) * 97 / 100)
      << "what was not lost came in";
}

TEST_F(Rekeying, KeepsTheSessionWhereNoHandshakePasses) {
  street.on_passing = [&](SealedStreet::Passing& passing) {
    const auto opening = seal::parse(passing.bytes);
    return opening && opening->form == seal::Form::kCompact;
  };
  talk(Duration::s(20));
  EXPECT_EQ(rekeyings(), 0u);
  EXPECT_EQ(house->sealed, 1);
  EXPECT_TRUE(house->troubles.empty()) << "the user is not told of what does no harm";
  EXPECT_EQ(received_up(), static_cast<std::size_t>(said_));
  street.on_passing = {};
  talk(Duration::s(61));
  EXPECT_GE(rekeyings(), 1u) << "it tries again after a minute";
}

TEST_F(Rekeying, KeepsTheSessionWhenTheServerNeverSwitches) {
  street.on_passing = [&](SealedStreet::Passing& passing) {
    // The announcement is the one datagram of its length.
    return passing.bytes.size() != seal::kRekeyBytes + seal::kOverhead;
  };
  talk(Duration::s(20));
  EXPECT_EQ(rekeyings(), 0u);
  EXPECT_EQ(house->sealed, 1);
  EXPECT_EQ(received_up(), static_cast<std::size_t>(said_));
  EXPECT_EQ(street.server->peer_count(), 1u) << "the session that came to nothing was closed";
}

TEST_F(Rekeying, ReconnectsToAServerThatRestartsDuringRekeying) {
  talk(Duration::ms(1200));
  street.server.reset();
  street.run(Duration::ms(200));
  street.start_server();
  street.heard.clear();
  street.run(Duration::s(4));
  const int before = said_;
  talk(Duration::s(2));
  EXPECT_GE(house->sealed, 2) << "a session of the new server";
  EXPECT_EQ(received_up(), static_cast<std::size_t>(said_ - before));
}

TEST_F(Rekeying, EndsWithTheSessionThatTheServerEnds) {
  street.on_passing = [&](SealedStreet::Passing& passing) {
    return passing.bytes.size() != seal::kRekeyBytes + seal::kOverhead;
  };
  while (street.server->peer_count() < 2 && said_ < 1000) talk(Duration::ms(50));
  ASSERT_EQ(street.server->peer_count(), 2u) << "the new session waits to be used";
  street.server.reset();  // it closes both
  street.run(Duration::s(1));
  EXPECT_FALSE(house->client->is_sealed());
  street.on_passing = {};
  street.start_server();
  street.run(Duration::s(4));
  EXPECT_EQ(house->sealed, 2);
}

TEST_F(Rekeying, AcceptsLateDatagramsForALimitedTime) {
  talk(Duration::ms(600));
  ASSERT_EQ(rekeyings(), 0u);
  std::vector<SealedStreet::Passing> held;
  street.on_passing = [&](SealedStreet::Passing& passing) {
    if (passing.to_server) held.push_back(passing);
    return !passing.to_server;
  };
  street.say(*house, "late");
  street.say(*house, "too late");
  street.on_passing = {};
  ASSERT_EQ(held.size(), 2u);
  // No other datagram is sent: one older than the newest 64 is refused, late or not.
  for (int i = 0; i < 100 && rekeyings() == 0; ++i) street.run(Duration::ms(50));
  ASSERT_EQ(rekeyings(), 1u);
  const auto has_heard = [&](const char* text) {
    return std::ranges::count(street.heard, text, &SealedStreet::Heard::text) > 0;
  };
  EXPECT_FALSE(has_heard("late"));
  street.deliver(held[0]);
  EXPECT_TRUE(has_heard("late"));
  house->client->set_rekey_limits({Duration::s(3600), 1u << 26});
  talk(seal::kPreviousSessionStays + Duration::s(2));
  street.deliver(held[1]);
  EXPECT_FALSE(has_heard("too late"));
  EXPECT_EQ(street.server->counters().of(SealReject::kUnknownId), 1u);
}

// Holders of a room's key can make sessions too, and can read the ids of all sessions on the way.
TEST(RekeyingOfOthers, ASessionOfAnotherHouseIsNotTakenOver) {
  const GuestKey salsa = key_of("salsa", KeyKind::kRoom), bobs = key_of("bob");
  SealedStreet street({salsa, bobs});
  auto& alice = street.add_house("salsa", PrivateKey::make(), salsa.own);
  auto& mallory = street.add_house("salsa", PrivateKey::make(), salsa.own);
  auto& bob = street.add_house("bob", bobs.own);
  street.run(Duration::ms(300));
  for (auto* house : {&alice, &mallory, &bob}) street.say(*house, "here");
  street.run(Duration::ms(50));
  ASSERT_EQ(street.heard.size(), 3u);
  const auto peer_of = [&](std::size_t i) { return street.heard[i].peer; };
  for (auto* thief : {&mallory, &bob})
    for (std::size_t victim = 0; victim < 3; ++victim) {
      std::string message(seal::kRekeyBytes, '\0');
      message[0] = static_cast<char>(seal::kRekey);
      const std::uint64_t id = peer_of(victim);
      std::memcpy(message.data() + 1, &id, sizeof id);
      street.say(*thief, message);
    }
  for (const std::size_t size : {std::size_t{1}, seal::kRekeyBytes - 1, seal::kRekeyBytes + 1})
    street.say(mallory, std::string(size, static_cast<char>(seal::kRekey)));
  street.run(Duration::ms(50));
  EXPECT_EQ(street.server->counters().rekeyings, 0u);
  EXPECT_EQ(street.server->counters().of(SealReject::kForged), 4u);
  EXPECT_EQ(street.server->counters().of(SealReject::kMalformed), 3u);
  EXPECT_EQ(street.heard.size(), 3u) << "none of it reaches the rooms";
  EXPECT_EQ(street.server->peer_count(), 3u);
  street.answer(peer_of(0), "still here");
  street.run(Duration::ms(50));
  EXPECT_EQ(alice.heard.back(), "still here");
}

// A request to change to this session. With the wrong proof, as `byte` 16 times.
std::string rekey_request(std::uint64_t id, char byte) {
  std::string message(seal::kRekeyBytes, byte);
  message[0] = static_cast<char>(seal::kRekey);
  std::memcpy(message.data() + 1, &id, sizeof id);
  return message;
}

// A guest with two sessions of one key asks 1,000 times a second.
class RekeyFlood : public ::testing::Test {
 protected:
  void SetUp() override {
    street.run(Duration::ms(300));
    for (auto* house : {first, second, other}) street.say(*house, "here");
    street.run(Duration::ms(50));
    ASSERT_EQ(street.heard.size(), 3u);
  }
  // Answers keep the guest's link from making another session.
  void flood(const std::string& request, Duration duration) {
    for (const MonoTime end = street.now + duration; street.now < end;) {
      for (int i = 0; i < 5; ++i) street.say(*first, request);
      for (const auto& heard : street.heard) street.answer(heard.peer, "pong");
      street.run(Duration::ms(5));
    }
  }
  std::uint64_t rejected(SealReject cause) const { return street.server->counters().of(cause); }

  const GuestKey mallory = key_of("mallory"), alice = key_of("alice");
  SealedStreet street{{mallory, alice}};
  SealedStreet::House* first = &street.add_house("mallory", mallory.own);
  SealedStreet::House* second = &street.add_house("mallory", mallory.own);
  SealedStreet::House* other = &street.add_house("alice", alice.own);
};

// Each wrong proof costs the server a key derivation.
TEST_F(RekeyFlood, WrongProofsForAnOwnSessionAreCheckedEightTimesASecond) {
  flood(rekey_request(street.heard[1].peer, 'x'), Duration::s(10));
  EXPECT_GE(rejected(SealReject::kForged), 80u);
  EXPECT_LE(rejected(SealReject::kForged), 8u + 81u);
  EXPECT_EQ(rejected(SealReject::kForged) + rejected(SealReject::kControlRate), 10'000u);
}

TEST_F(RekeyFlood, RequestsForTheCurrentSessionAreAnsweredEightTimesASecond) {
  const std::uint64_t before = street.server->counters().datagrams_out;
  flood(rekey_request(street.heard[0].peer, 'x'), Duration::s(10));
  // One pong for each of three peers every 5 ms.
  const std::uint64_t answers = street.server->counters().datagrams_out - before - 3u * 2'000u;
  EXPECT_GE(answers, 80u);
  EXPECT_LE(answers, 8u + 81u);
  EXPECT_EQ(answers + rejected(SealReject::kControlRate), 10'000u);
}

TEST_F(RekeyFlood, KeepsNobodyElseFromNewKeysAndDropsNoData) {
  other->client->set_rekey_limits({Duration::s(1), 1u << 26});
  flood(rekey_request(street.heard[1].peer, 'x'), Duration::s(5));
  EXPECT_GE(other->client->counters().rekeyings, 1u);
  street.say(*first, "data");
  street.run(Duration::ms(5));
  EXPECT_EQ(street.heard.back().text, "data");
  // After the flood the guest gets new keys too.
  street.run(Duration::s(1));
  first->client->set_rekey_limits({Duration::s(1), 1u << 26});
  street.run(Duration::s(3));
  EXPECT_GE(first->client->counters().rekeyings, 1u);
}

}  // namespace
}  // namespace dance

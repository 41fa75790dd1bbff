// How houses come to sealed sessions, and who does not.
#include <gtest/gtest.h>

#include "tests/tunnel/seal/sealed_street.h"

namespace dance {
namespace {

TEST(SealHandshake, BothSidesHearEachOtherUnderTheNameOfTheKey) {
  const KeyEntry alice = key_of("alice");
  SealedStreet street({alice});
  auto& house = street.add_house("alice", alice.key);
  street.run(Duration::ms(20));
  ASSERT_EQ(house.sealed, 1);
  EXPECT_EQ(house.client->cipher(), "ECDHE-PSK-CHACHA20-POLY1305");
  street.say(house, "good evening");
  street.run(Duration::ms(10));
  ASSERT_EQ(street.heard.size(), 1u);
  EXPECT_EQ(street.heard[0].name, "alice");
  EXPECT_EQ(street.heard[0].text, "good evening");
  street.answer(street.heard[0].peer, "shall we?");
  street.run(Duration::ms(10));
  ASSERT_EQ(house.heard.size(), 1u);
  EXPECT_EQ(house.heard[0], "shall we?");
  // A sealed datagram is its plaintext and 26 bytes.
  EXPECT_EQ(street.sent.back().bytes.size(), std::string("shall we?").size() + seal::kOverhead);
  for (const auto& passed : street.sent) {
    const std::string text(passed.bytes.begin(), passed.bytes.end());
    EXPECT_EQ(text.find("shall"), std::string::npos);
    EXPECT_EQ(text.find("evening"), std::string::npos);
  }
}

TEST(SealHandshake, WrongKeyAndUnknownNameGetNothingAndLookAlike) {
  const KeyEntry alice = key_of("alice");
  SealedStreet street({alice});
  auto& wrong = street.add_house("alice", PresharedKey::make());
  auto& unknown = street.add_house("mallory", PresharedKey::make());
  street.run(Duration::ms(100));
  for (auto* house : {&wrong, &unknown}) {
    EXPECT_EQ(house->sealed, 0);
    ASSERT_EQ(house->troubles.size(), 1u);
    EXPECT_EQ(house->troubles[0], SealTrouble::kWrongKey);
  }
  EXPECT_EQ(street.server->counters().of(SealReject::kWrongKey), 1u);
  EXPECT_EQ(street.server->counters().of(SealReject::kUnknownName), 1u);
  EXPECT_EQ(street.server->peer_count(), 0u);
  EXPECT_EQ(street.server->handshake_count(), 0u);
  EXPECT_EQ(street.bytes_to(wrong.address), street.bytes_to(unknown.address));
}

TEST(SealHandshake, AStrangerIsKeptNowhereAndNeverAnsweredWithMore) {
  const KeyEntry alice = key_of("alice");
  SealedStreet street({alice});
  auto& house = street.add_house("alice", alice.key);
  // The first datagram, from a thousand addresses that never answer.
  house.client->tick(street.now);
  ASSERT_EQ(street.sent.size(), 1u);
  const auto hello = street.sent[0].bytes;
  street.passing.clear();
  for (std::uint16_t i = 0; i < 100; ++i) {
    const std::size_t before = street.sent.size();
    street.inject(Address::loopback(static_cast<std::uint16_t>(20'000 + i)), hello);
    std::size_t answered = 0;
    for (std::size_t k = before; k < street.sent.size(); ++k)
      answered += street.sent[k].bytes.size();
    EXPECT_GT(answered, 0u);
    EXPECT_LE(answered, hello.size());
  }
  EXPECT_EQ(street.server->handshake_count(), 0u);
  EXPECT_EQ(street.server->counters().cookies_given, 100u);
}

TEST(SealHandshake, ACookieIsOfOneAddressAndNotForEver) {
  const KeyEntry alice = key_of("alice");
  SealedStreet street({alice});
  auto& house = street.add_house("alice", alice.key);
  std::vector<std::uint8_t> with_cookie;
  int number = 0;
  street.on_passing = [&](SealedStreet::Passing& passing) {
    if (passing.to_server && ++number == 2) {
      with_cookie = passing.bytes;
      return false;
    }
    return true;
  };
  street.run(Duration::ms(10));
  ASSERT_FALSE(with_cookie.empty());
  street.on_passing = {};
  street.inject(Address::loopback(999), with_cookie);
  EXPECT_EQ(street.server->counters().of(SealReject::kBadCookie), 1u);
  EXPECT_EQ(street.server->handshake_count(), 0u);
  // After two changes of the secret it is void at its own address too.
  for (int i = 0; i < 3; ++i) {
    street.now += Duration::s(61);
    street.server->tick(street.now);
  }
  street.inject(house.address, with_cookie);
  EXPECT_EQ(street.server->counters().of(SealReject::kBadCookie), 2u);
  EXPECT_EQ(street.server->handshake_count(), 0u);
}

TEST(SealHandshake, OneNoisyNetworkLeavesTheOthersTheirTurn) {
  const KeyEntry alice = key_of("alice");
  SealedStreet street({alice});
  auto& house = street.add_house("alice", alice.key);
  house.client->tick(street.now);
  auto hello = street.sent[0].bytes;
  street.passing.clear();
  const Address noisy = *Address::resolve("192.0.2.7:1000");
  for (int i = 0; i < 5000; ++i) {
    hello[1] = static_cast<std::uint8_t>(i);
    hello[2] = static_cast<std::uint8_t>(i >> 8);
    street.inject(noisy, hello);
  }
  EXPECT_GT(street.server->counters().of(SealReject::kStrangerRate), 4000u);
  EXPECT_EQ(street.server->counters().of(SealReject::kCrowdRate), 0u);
  // A second try, as the first hello was not delivered.
  street.run(Duration::ms(1700));
  EXPECT_EQ(house.sealed, 1);
}

TEST(SealHandshake, HandshakesThatAreNotEndedAreBoundedAndForgotten) {
  const KeyEntry alice = key_of("alice");
  SealLimits limits;
  limits.handshakes = 4;
  SealedStreet street({alice}, limits);
  // The link's third flight, with the proof, never comes.
  street.on_passing = [](SealedStreet::Passing& passing) {
    return !passing.to_server || seal::cookie_of(seal::parse(passing.bytes)->body).has_value();
  };
  for (int i = 0; i < 6; ++i) street.add_house("alice", alice.key);
  street.run(Duration::ms(20));
  // The oldest made room.
  EXPECT_EQ(street.server->handshake_count(), 4u);
  EXPECT_EQ(street.server->counters().of(SealReject::kTimedOut), 2u);
  for (auto& house : street.houses) house->is_cut = true;
  street.run(Duration::s(6));
  EXPECT_EQ(street.server->handshake_count(), 0u);
  EXPECT_GE(street.server->counters().of(SealReject::kTimedOut), 4u);
  EXPECT_EQ(street.server->peer_count(), 0u);
}

TEST(SealHandshake, OneNetworkDoesNotTakeAllPlaces) {
  const KeyEntry alice = key_of("alice");
  SealLimits limits;
  limits.handshakes = 8;
  limits.handshakes_per_network = 6;
  SealedStreet street({alice}, limits);
  // Eleven who begin and go no further, ten of them from one network.
  bool stalls = true;
  street.on_passing = [&](SealedStreet::Passing& passing) {
    return !stalls || !passing.to_server ||
           seal::cookie_of(seal::parse(passing.bytes)->body).has_value();
  };
  for (int i = 0; i < 10; ++i) street.add_house("alice", alice.key);
  for (int i = 0; i < 3; ++i) {
    auto& other = street.add_house("alice", alice.key);
    other.address = *Address::resolve("198.51.100." + std::to_string(i + 1) + ":1");
  }
  street.run(Duration::ms(20));
  EXPECT_EQ(street.server->counters().of(SealReject::kFull), 4u);
  EXPECT_EQ(street.server->handshake_count(), 8u);
  stalls = false;
  auto& guest = street.add_house("alice", alice.key);
  guest.address = *Address::resolve("203.0.113.5:1");
  street.run(Duration::ms(20));
  EXPECT_EQ(guest.sealed, 1);
}

TEST(SealHandshake, AKeyThatIsTakenBackMeanwhileLetsNobodyIn) {
  const KeyEntry alice = key_of("alice"), bob = key_of("bob");
  SealedStreet street({alice, bob});
  auto& house = street.add_house("alice", alice.key);
  // The key has been looked up; what proves it is held back.
  std::vector<SealedStreet::Passing> held;
  street.on_passing = [&](SealedStreet::Passing& passing) {
    if (!passing.to_server || seal::cookie_of(seal::parse(passing.bytes)->body)) return true;
    seal::Bytes rest = seal::parse(passing.bytes)->body;
    std::size_t clear = seal::kIdBytes;
    while (const auto record = seal::take_record(rest)) {
      if (record->epoch == 0) clear += record->whole.size();
    }
    held.push_back(passing);
    auto only_clear = passing;
    only_clear.bytes.resize(clear);
    passing = only_clear;
    return true;
  };
  street.run(Duration::ms(10));
  ASSERT_EQ(street.server->handshake_count(), 1u);
  ASSERT_FALSE(held.empty());
  street.set_keys({bob});
  for (const auto& late : held) street.deliver(late);
  street.on_passing = {};
  EXPECT_EQ(street.server->peer_count(), 0u);
  EXPECT_EQ(street.server->counters().of(SealReject::kWrongKey), 1u);
  street.run(Duration::ms(10));
  street.say(house, "let me in");
  street.run(Duration::ms(10));
  EXPECT_TRUE(street.heard.empty());
}

TEST(SealHandshake, LostDatagramsAreSentAgain) {
  const KeyEntry alice = key_of("alice");
  for (int lost = 0; lost < 6; ++lost) {
    SealedStreet street({alice});
    auto& house = street.add_house("alice", alice.key);
    int number = 0;
    street.on_passing = [&](SealedStreet::Passing&) { return number++ != lost; };
    const MonoTime begin = street.now;
    // The timers of OpenSSL run by the real clock: time passes here as it does there, slowly.
    for (int i = 0; i < 400 && house.sealed == 0; ++i) {
      street.run(Duration::ms(5));
      timespec pause{0, 5'000'000};
      nanosleep(&pause, nullptr);
    }
    EXPECT_EQ(house.sealed, 1) << "without datagram " << lost;
    EXPECT_EQ(house.client->counters().tries, 1u) << "without datagram " << lost;
    street.say(house, "there");
    // What comes before the handshake's last flight has come again finds no session yet.
    for (int i = 0; i < 400 && street.heard.empty(); ++i) {
      street.run(Duration::ms(5));
      street.say(house, "there");
    }
    EXPECT_FALSE(street.heard.empty()) << "without datagram " << lost;
    EXPECT_LT(street.now - begin, Duration::s(10));
  }
}

TEST(SealHandshake, TheKeyOfThisMachineIsForThisMachine) {
  KeyEntry local = key_of("local", KeyKind::kRoom);
  local.is_local = true;
  SealedStreet street({local});
  auto& here = street.add_house("local", local.key);
  auto& there = street.add_house("local", local.key);
  there.address = *Address::resolve("192.0.2.9:1000");
  street.run(Duration::ms(50));
  EXPECT_EQ(here.sealed, 1);
  EXPECT_EQ(there.sealed, 0);
  EXPECT_EQ(street.server->counters().of(SealReject::kNotLocal), 1u);
}

TEST(SealHandshake, AKeyThatIsTakenBackEndsItsSessions) {
  const KeyEntry alice = key_of("alice"), bob = key_of("bob");
  SealedStreet street({alice, bob});
  auto& a = street.add_house("alice", alice.key);
  auto& b = street.add_house("bob", bob.key);
  street.run(Duration::ms(20));
  ASSERT_EQ(a.sealed + b.sealed, 2);
  street.set_keys({bob});
  EXPECT_EQ(street.ended.size(), 1u);
  EXPECT_EQ(street.server->peer_count(), 1u);
  street.run(Duration::ms(100));
  EXPECT_EQ(a.sealed, 1);
  ASSERT_FALSE(a.troubles.empty());
  EXPECT_EQ(a.troubles[0], SealTrouble::kWrongKey);
  street.say(b, "still here");
  street.run(Duration::ms(10));
  ASSERT_EQ(street.heard.size(), 1u);
}

TEST(SealHandshake, ALinkOfBeforeIsToldThatItIsOld) {
  SealedStreet street({key_of("alice")});
  std::vector<std::uint8_t> hello(512);
  const std::array<std::uint8_t, 8> head{0x44, 0x43, 0x47, 0x52, 2, 1, 0, 0};
  std::copy(head.begin(), head.end(), hello.begin());
  for (std::uint8_t i = 0; i < 8; ++i) hello[8 + i] = i;
  street.inject(Address::loopback(5), hello);
  ASSERT_EQ(street.sent.size(), 1u);
  const std::vector<std::uint8_t> refusal{0x44, 0x43, 0x47, 0x52, 4, 3, 1, 0, 0,
                                          1,    2,    3,    4,    5, 6, 7, 0};
  EXPECT_EQ(street.sent[0].bytes, refusal);
  EXPECT_EQ(street.server->counters().of(SealReject::kOldVersion), 1u);
}

}  // namespace
}  // namespace dance

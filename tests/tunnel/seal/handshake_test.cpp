// How houses come to sealed sessions, and who does not.
#include <gtest/gtest.h>

#include "tests/tunnel/seal/sealed_street.h"

namespace dance {
namespace {

TEST(SealHandshake, BothSidesHearEachOtherUnderTheNameOfTheKey) {
  const GuestKey alice = key_of("alice");
  SealedStreet street({alice});
  auto& house = street.add_house("alice", alice.own);
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
  const GuestKey alice = key_of("alice");
  SealedStreet street({alice});
  auto& wrong = street.add_house("alice", PrivateKey::make());
  auto& unknown = street.add_house("mallory", PrivateKey::make());
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

// A copy of the server's list of keys, or a room's key, does not prove the server.
TEST(SealHandshake, ALinkSendsNoIdentityWhenTheServerNamesAnotherKey) {
  const GuestKey salsa = key_of("salsa", KeyKind::kRoom);
  SealedStreet impostor({salsa});
  const PrivateKey real = PrivateKey::make(), house = PrivateKey::make();
  const auto key = house_session_key(house, salsa.own, real.public_key());
  auto& guest =
      impostor.add_house(identity_text("salsa", house.public_key()), *key, real.public_key());
  impostor.run(Duration::ms(100));
  EXPECT_EQ(guest.sealed, 0);
  ASSERT_FALSE(guest.troubles.empty());
  EXPECT_EQ(guest.troubles[0], SealTrouble::kServerKeyChanged);
  for (const auto& passed : impostor.sent) {
    const std::string text(passed.bytes.begin(), passed.bytes.end());
    EXPECT_EQ(text.find("salsa"), std::string::npos) << "not even the house's name";
  }
  // Nor does it help to name the real server's key, as anybody can read it on the way.
  auto& fooled = impostor.add_house(identity_text("salsa", house.public_key()), *key, PublicKey());
  impostor.run(Duration::ms(100));
  EXPECT_EQ(fooled.sealed, 0);
  ASSERT_FALSE(fooled.troubles.empty());
  EXPECT_EQ(fooled.troubles[0], SealTrouble::kWrongKey);
}

TEST(SealHandshake, AHolderOfARoomsKeyCannotClaimAnotherHousesIdentity) {
  const GuestKey salsa = key_of("salsa", KeyKind::kRoom);
  SealedStreet street({salsa});
  const PrivateKey house = PrivateKey::make();
  auto& alice = street.add_house("salsa", house, salsa.own);
  street.run(Duration::ms(20));
  EXPECT_EQ(alice.sealed, 1);
  // Another holder of the room's key claims the identity of this house.
  const auto key = house_session_key(PrivateKey::make(), salsa.own, street.identity.public_key());
  auto& mallory = street.add_house(identity_text("salsa", house.public_key()), *key,
                                   street.identity.public_key());
  street.run(Duration::ms(100));
  EXPECT_EQ(mallory.sealed, 0);
  EXPECT_EQ(street.server->counters().of(SealReject::kWrongKey), 1u);
}

TEST(SealHandshake, RefusesAnIdentityOffTheCurve) {
  const GuestKey alice = key_of("alice");
  SealedStreet street({alice});
  std::string off_curve;
  for (char c = 'A'; off_curve.empty(); ++c) {
    std::string text = alice.key.text();
    text[30] = c;
    if (const auto key = PublicKey::parse(text); key && !key->is_on_curve()) off_curve = text;
  }
  for (const std::string& identity :
       {"alice:" + off_curve, std::string("alice:"), std::string("alice"), std::string(":"),
        "alice:alice:" + alice.key.text(), std::string(120, ':')})
    street.add_house(identity, PresharedKey::make(), street.identity.public_key());
  street.run(Duration::ms(100));
  for (const auto& house : street.houses) EXPECT_EQ(house->sealed, 0);
  EXPECT_EQ(street.server->peer_count(), 0u);
  EXPECT_EQ(street.server->handshake_count(), 0u);
}

TEST(SealHandshake, AStrangerIsKeptNowhereAndNeverAnsweredWithMore) {
  const GuestKey alice = key_of("alice");
  SealedStreet street({alice});
  auto& house = street.add_house("alice", alice.own);
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
  const GuestKey alice = key_of("alice");
  SealedStreet street({alice});
  auto& house = street.add_house("alice", alice.own);
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
  const GuestKey alice = key_of("alice");
  SealedStreet street({alice});
  auto& house = street.add_house("alice", alice.own);
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
  const GuestKey alice = key_of("alice");
  SealLimits limits;
  limits.handshakes = 4;
  SealedStreet street({alice}, limits);
  // The link's third flight, with the proof, never comes.
  street.on_passing = [](SealedStreet::Passing& passing) {
    return !passing.to_server || seal::cookie_of(seal::parse(passing.bytes)->body).has_value();
  };
  for (int i = 0; i < 6; ++i) street.add_house("alice", alice.own);
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

TEST(SealHandshake, NewcomersOfOtherNetworksKeepTheirPlaces) {
  const GuestKey alice = key_of("alice");
  SealLimits limits;
  limits.handshakes = 8;
  SealedStreet street({alice}, limits);
  // These guests begin a handshake and go no further: a slow guest first, then 20 of one IPv6 /48.
  bool stalls = true;
  street.on_passing = [&](SealedStreet::Passing& passing) {
    return !stalls || !passing.to_server ||
           seal::cookie_of(seal::parse(passing.bytes)->body).has_value();
  };
  auto& slow = street.add_house("alice", alice.own);
  slow.address = *Address::resolve("203.0.113.5:1");
  street.run(Duration::ms(20));
  ASSERT_EQ(street.server->handshake_count(), 1u);
  for (int i = 0; i < 20; ++i) {
    auto& attacker = street.add_house("alice", alice.own);
    attacker.address = *Address::resolve("[2001:db8:1:" + std::to_string(100 + i) + "::1]:1");
  }
  street.run(Duration::ms(40));
  EXPECT_EQ(street.server->handshake_count(), 8u);
  EXPECT_EQ(street.server->counters().of(SealReject::kTimedOut), 13u);
  // The slow guest's handshake is among those that were kept.
  stalls = false;
  for (std::size_t i = 1; i < street.houses.size(); ++i) street.houses[i]->is_cut = true;
  for (int i = 0; i < 60 && slow.sealed == 0; ++i) {  // OpenSSL's timers run by the real clock
    street.run(Duration::ms(10));
    timespec pause{0, 20'000'000};
    nanosleep(&pause, nullptr);
  }
  EXPECT_EQ(slow.sealed, 1);
  EXPECT_EQ(slow.client->counters().tries, 1u);
}

// An attack: 3,000 first datagrams a second, each with a valid cookie, from /64s of
// one IPv6 /48. Before, one rate for all was used up, and no newcomer came in.
TEST(SealHandshake, NewcomerGetsItsTurnDuringAFloodFromOneWideNetwork) {
  const GuestKey alice = key_of("alice");
  SealedStreet street({alice});
  // One real link makes the attacker's datagrams, one for each address.
  bool attacks = true;
  std::vector<std::pair<Address, std::vector<std::uint8_t>>> flood;
  street.on_passing = [&](SealedStreet::Passing& passing) {
    if (!attacks || !passing.to_server) return true;
    const auto cookie = seal::cookie_of(seal::parse(passing.bytes)->body);
    if (cookie && !cookie->empty()) {
      flood.emplace_back(passing.peer, passing.bytes);
      return false;
    }
    return true;
  };
  constexpr int kAddresses = 1500;
  for (int i = 0; i < kAddresses; ++i) {
    auto& attacker = street.add_house("alice", PrivateKey::make());
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "[2001:db8:1:%x::1]:1", static_cast<unsigned>(i * 43));
    attacker.address = *Address::resolve(text.data());
    attacker.client->tick(street.now);
    if (i % 100 == 99) street.run(Duration::ms(5));
  }
  street.run(Duration::ms(50));
  ASSERT_GE(flood.size(), static_cast<std::size_t>(kAddresses));
  for (auto& house : street.houses) house->is_cut = true;
  attacks = false;
  // 15 each 5 ms; the burst of the start is used up after two seconds.
  std::size_t next = 0;
  const auto flood_for = [&](Duration duration, const auto& is_over) {
    const MonoTime begin = street.now;
    while (street.now - begin < duration && !is_over()) {
      for (int i = 0; i < 15; ++i, ++next) {
        auto bytes = flood[next % flood.size()].second;
        street.inject(flood[next % flood.size()].first, bytes);
      }
      street.run(Duration::ms(5));
    }
    return street.now - begin;
  };
  street.houses.clear();
  flood_for(Duration::s(3), [] { return false; });
  EXPECT_GT(street.server->counters().of(SealReject::kCrowdRate), 1000u);
  for (int i = 0; i < 10; ++i) {
    auto& guest = street.add_house("alice", alice.own);
    guest.address = *Address::resolve("198.51." + std::to_string(100 + i) + ".7:1");
    const Duration took = flood_for(Duration::s(2), [&] { return guest.sealed > 0; });
    EXPECT_EQ(guest.sealed, 1) << "guest " << i;
    EXPECT_LT(took, Duration::ms(100)) << "guest " << i;
  }
}

TEST(SealHandshake, AKeyThatIsTakenBackMeanwhileLetsNobodyIn) {
  const GuestKey alice = key_of("alice"), bob = key_of("bob");
  SealedStreet street({alice, bob});
  auto& house = street.add_house("alice", alice.own);
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
  const GuestKey alice = key_of("alice");
  for (int lost = 0; lost < 6; ++lost) {
    SealedStreet street({alice});
    auto& house = street.add_house("alice", alice.own);
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
  local.local_key = PresharedKey::make();
  SealedStreet street({local});
  auto& here = street.add_house("local", *local.local_key, PublicKey());
  auto& there = street.add_house("local", *local.local_key, PublicKey());
  there.address = *Address::resolve("192.0.2.9:1000");
  street.run(Duration::ms(50));
  EXPECT_EQ(here.sealed, 1);
  EXPECT_EQ(there.sealed, 0);
  EXPECT_EQ(street.server->counters().of(SealReject::kNotLocal), 1u);
  EXPECT_EQ(street.server->counters().of(SealReject::kNoAgreement), 0u) << "refused once";
}

TEST(SealHandshake, AKeyThatIsTakenBackEndsItsSessions) {
  const GuestKey alice = key_of("alice"), bob = key_of("bob");
  SealedStreet street({alice, bob});
  auto& a = street.add_house("alice", alice.own);
  auto& b = street.add_house("bob", bob.own);
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

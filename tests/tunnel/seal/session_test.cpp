// What becomes of sealed sessions: other addresses, forgeries, copies, ends and new beginnings.
#include <gtest/gtest.h>
#include <openssl/crypto.h>

#include "core/net/secure_random.h"
#include "tests/allocation_guard.h"
#include "tests/tunnel/seal/sealed_street.h"

namespace dance {
namespace {

class SealSession : public ::testing::Test {
 protected:
  void SetUp() override {
    street.run(Duration::ms(20));
    ASSERT_EQ(house.sealed, 1);
    street.say(house, "hello");
    street.run(Duration::ms(10));
    ASSERT_EQ(street.heard.size(), 1u);
    peer = street.heard[0].peer;
  }
  const GuestKey alice = key_of("alice");
  SealedStreet street{{alice}};
  SealedStreet::House& house = street.add_house("alice", alice.own);
  const Address first = house.address;
  std::uint64_t peer = 0;
};

TEST_F(SealSession, GoesOnAtOnceFromAnotherAddress) {
  house.address = Address::loopback(4321);
  street.say(house, "from the train");
  street.run(Duration::ms(10));
  ASSERT_EQ(street.heard.size(), 2u);
  EXPECT_EQ(street.heard[1].peer, peer);
  EXPECT_EQ(street.server->address_of(peer), house.address);
  EXPECT_EQ(street.server->counters().moves, 1u);
  street.answer(peer, "welcome back");
  street.run(Duration::ms(10));
  EXPECT_EQ(house.heard, std::vector<std::string>{"welcome back"});
  EXPECT_EQ(house.sealed, 1);
}

TEST_F(SealSession, ANewAddressHearsLittleBeforeItHasAnswered) {
  // A guest who names somebody else as her address: nobody answers there.
  house.address = Address::loopback(4321);
  street.on_passing = [&](SealedStreet::Passing& passing) {
    return passing.to_server || passing.peer != house.address;
  };
  street.say(house, "send it there");
  street.run(Duration::ms(5));
  ASSERT_EQ(street.server->address_of(peer), house.address);
  for (int i = 0; i < 1000; ++i) street.answer(peer, std::string(100, 'x'));
  std::size_t said = 0;
  for (const auto& passed : street.sent)
    if (passed.to_server && passed.peer == house.address) said += passed.bytes.size();
  EXPECT_LE(street.bytes_to(house.address), 3 * said);
  EXPECT_GT(street.server->counters().unproven, 900u);
  // Back where she was she is known.
  house.address = first;
  street.say(house, "here");
  street.run(Duration::ms(5));
  const std::size_t before = street.bytes_to(first);
  for (int i = 0; i < 10; ++i) street.answer(peer, std::string(100, 'x'));
  EXPECT_EQ(street.bytes_to(first) - before, 10 * (100 + seal::kOverhead));
  // And elsewhere once she answers.
  house.address = Address::loopback(4322);
  street.on_passing = {};
  street.say(house, "really there");
  street.run(Duration::ms(15));
  const std::size_t there = street.bytes_to(house.address);
  for (int i = 0; i < 10; ++i) street.answer(peer, std::string(100, 'x'));
  EXPECT_EQ(street.bytes_to(house.address) - there, 10 * (100 + seal::kOverhead));
  for (const auto& heard : street.heard) EXPECT_LT(heard.text.size(), 20u) << "answers stay within";
}

TEST_F(SealSession, ACopyFromElsewhereMovesNothing) {
  const auto copy = street.sent.back();
  ASSERT_TRUE(copy.to_server);
  street.inject(Address::loopback(666), copy.bytes);
  EXPECT_EQ(street.server->counters().of(SealReject::kReplayed), 1u);
  EXPECT_EQ(street.server->address_of(peer), first);
  EXPECT_EQ(street.heard.size(), 1u);
  // An older record that was held back counts, and does not move the address either.
  std::vector<std::uint8_t> held;
  street.on_passing = [&](SealedStreet::Passing& passing) {
    held = passing.bytes;
    return false;
  };
  street.say(house, "late");
  street.on_passing = {};
  street.say(house, "newer");
  street.run(Duration::ms(10));
  street.inject(Address::loopback(666), held);
  ASSERT_EQ(street.heard.size(), 3u);
  EXPECT_EQ(street.heard[2].text, "late");
  EXPECT_EQ(street.server->address_of(peer), first);
}

TEST_F(SealSession, WhatIsForgedOrMutatedGetsNothing) {
  const auto good = street.sent.back().bytes;
  for (std::size_t i = seal::kIdBytes; i < good.size(); ++i) {
    for (const int bit : {0, 3, 7}) {
      auto bad = good;
      // The next sequence, so that it is no copy.
      bad[seal::kIdBytes] = static_cast<std::uint8_t>(bad[seal::kIdBytes] + 1);
      bad[i] = static_cast<std::uint8_t>(bad[i] ^ (1 << bit));
      street.inject(first, bad);
    }
  }
  EXPECT_EQ(street.heard.size(), 1u);
  EXPECT_GT(street.server->counters().of(SealReject::kForged), 60u);
  street.say(house, "all is well");
  street.run(Duration::ms(10));
  EXPECT_EQ(street.heard.size(), 2u);
}

TEST_F(SealSession, RecordsInTheClearDoNothingToIt) {
  // An alert that says the session ends, a handshake message, a change of keys: of epoch 0.
  std::vector<std::uint8_t> bytes(seal::kIdBytes);
  seal::write_opening(peer, seal::Form::kRecords, bytes);
  const std::vector<std::uint8_t> alert{21, 0xfe, 0xfd, 0, 0, 0, 0, 0, 0, 0, 9, 0, 2, 2, 0};
  bytes.insert(bytes.end(), alert.begin(), alert.end());
  for (int i = 0; i < 100; ++i) {
    bytes[seal::kIdBytes] = static_cast<std::uint8_t>(20 + i % 4);
    bytes[seal::kIdBytes + 4] = static_cast<std::uint8_t>(i % 3);  // epochs 0, 1, 2
    bytes[seal::kIdBytes + 10] = static_cast<std::uint8_t>(i);
    street.inject(first, bytes);
    street.inject(Address::loopback(77), bytes);
  }
  EXPECT_EQ(street.server->counters().of(SealReject::kForeignSource), 100u);
  EXPECT_TRUE(street.ended.empty());
  street.say(house, "untouched");
  street.run(Duration::ms(10));
  EXPECT_EQ(street.heard.size(), 2u);
}

TEST_F(SealSession, AServerThatBeganAnewIsFoundAtOnce) {
  street.server.reset();
  street.passing.clear();
  street.start_server();
  const MonoTime begin = street.now;
  street.say(house, "are you there?");
  street.run(Duration::ms(50));
  EXPECT_EQ(house.sealed, 2);
  EXPECT_LE(house.client->counters().notices, 1u);
  EXPECT_LE(street.now - begin, Duration::ms(100));
  street.say(house, "again");
  street.run(Duration::ms(10));
  EXPECT_EQ(street.heard.back().text, "again");
}

TEST_F(SealSession, ANoticeThatSomebodyInventedCostsAHandshakeAtMost) {
  std::vector<std::uint8_t> notice(seal::kIdBytes);
  seal::write_opening(peer, seal::Form::kNotice, notice);
  for (int i = 0; i < 50; ++i) house.client->receive(notice, street.now, street.now);
  EXPECT_TRUE(house.client->is_sealed());
  street.say(house, "undisturbed");
  street.run(Duration::ms(20));
  EXPECT_EQ(street.heard.back().text, "undisturbed");
  EXPECT_LE(house.client->counters().tries, 2u);
}

TEST_F(SealSession, AGoodbyeEndsItOnBothSides) {
  house.client->close();
  street.run(Duration::ms(10));
  EXPECT_EQ(street.ended, std::vector<std::uint64_t>{peer});
  EXPECT_EQ(street.server->peer_count(), 0u);
}

TEST_F(SealSession, SilenceEndsItAfterAMinuteAndNotBefore) {
  house.is_cut = true;
  street.run(Duration::s(55));
  EXPECT_EQ(street.server->peer_count(), 1u);
  house.is_cut = false;
  // The first datagram is enough, whatever was tried meanwhile.
  street.say(house, "back");
  street.run(Duration::ms(5));
  EXPECT_EQ(street.heard.back().text, "back");
  house.is_cut = true;
  street.run(Duration::s(63));
  EXPECT_EQ(street.server->peer_count(), 0u);
  EXPECT_GE(street.ended.size(), 1u);
}

TEST_F(SealSession, SequencesWrapTheirLowHalf) {
  for (int i = 0; i < 70'000; ++i) {
    street.say(house, "x");
    const auto next = std::move(street.passing.front());
    street.passing.pop_front();
    street.sent.clear();
    // A loss now and then, and long gaps.
    if (i % 7 == 0 || (i > 30'000 && i < 50'000)) continue;
    const std::size_t before = street.heard.size();
    street.deliver(next);
    ASSERT_EQ(street.heard.size(), before + 1) << i;
    street.heard.clear();
  }
}

TEST_F(SealSession, SealingAndOpeningAllocateNothing) {
  // One house, one server, nothing between them that would keep a datagram.
  struct Relay final : DatagramSink {
    std::array<std::uint8_t, seal::kMaxSealed> bytes;
    std::size_t size = 0;
    void send(const Address&, std::span<const std::uint8_t> from) override {
      std::copy(from.begin(), from.end(), bytes.begin());
      size = from.size();
    }
  };
  Relay up, down;
  std::size_t got_up = 0, got_down = 0;
  SealServer::Handlers at_server;
  std::uint64_t whom = 0;
  at_server.on_datagram = [&](std::uint64_t from, const KeyEntry&, seal::Bytes plain, MonoTime,
                              MonoTime) {
    whom = from;
    got_up += plain.size();
  };
  auto server = SealServer::make({}, street.identity, street.keys, std::nullopt, secure_random_u64,
                                 at_server, down);
  ASSERT_TRUE(server);
  SealClient::Handlers at_house;
  at_house.on_datagram = [&](seal::Bytes plain, MonoTime, MonoTime) { got_down += plain.size(); };
  const PublicKey server_key = street.identity.public_key();
  SealClient client(
      *SealContext::for_link(identity_text("alice", alice.key),
                             *house_session_key(alice.own, std::nullopt, server_key), server_key),
      secure_random_u64, at_house, up);
  MonoTime now = street.now;
  const Address from = Address::loopback(9);
  client.tick(now);
  for (int i = 0; i < 6; ++i) {
    (*server)->receive(from, {up.bytes.data(), up.size}, now, now);
    client.receive({down.bytes.data(), down.size}, now, now);
  }
  ASSERT_TRUE(client.is_sealed());
  const std::array<std::uint8_t, 200> plain{1, 2, 3};
  const auto pass = [&] {
    client.send({}, plain);
    (*server)->receive(from, {up.bytes.data(), up.size}, now, now);
    (*server)->send(whom, plain);
    client.receive({down.bytes.data(), down.size}, now, now);
  };
  for (int i = 0; i < 4; ++i) pass();
  const std::size_t before = got_down;
  // Since 3.2 OpenSSL's own packet writer takes two small blocks for each record that it writes,
  // and frees them in the same call; a pass writes two records.
  const std::uint64_t by_openssl = OpenSSL_version_num() >= 0x30200000UL ? 4'000 : 0;
  {
    AllocationGuard guard;
    for (int i = 0; i < 1000; ++i) pass();
    EXPECT_EQ(guard.allocations(), by_openssl);
  }
  EXPECT_EQ(got_down - before, 200'000u);
  EXPECT_GE(got_up, 200'000u);
}

// The other server could not open what the old session seals, and may be nobody's server at all.
TEST_F(SealSession, ConnectingToAnotherServerSendsNoDataBeforeThatServerHasASession) {
  street.server.reset();
  street.on_passing = [](SealedStreet::Passing&) { return false; };
  street.run(Duration::ms(20));
  house.client->connect_to_other_server(street.now);
  EXPECT_FALSE(house.client->is_sealed());
  street.sent.clear();
  for (int i = 0; i < 100; ++i) {
    street.say(house, "a pose");
    street.run(Duration::ms(10));
  }
  EXPECT_EQ(house.client->counters().unsealed, 100u);
  for (const auto& passed : street.sent) {
    const auto opening = seal::parse(passed.bytes);
    ASSERT_TRUE(opening);
    EXPECT_EQ(opening->form, seal::Form::kRecords) << "only handshakes";
  }
  street.on_passing = {};
  street.start_server();
  house.client->connect_to_other_server(street.now);
  street.run(Duration::ms(100));
  EXPECT_EQ(house.sealed, 2);
  street.say(house, "a pose");
  street.run(Duration::ms(10));
  EXPECT_EQ(street.heard.back().text, "a pose");
}

}  // namespace
}  // namespace dance

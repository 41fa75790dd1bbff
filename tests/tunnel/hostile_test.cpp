// What damage, and peers who mean ill, can do to a server and to a link: be counted, and nothing
// else.
#include <gtest/gtest.h>

#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Captured {
  bool to_server;
  PeerId peer;
  Bytes bytes;
};

// A dancing pair with hands, skeletons, a late joiner and a goodbye: every kind of datagram passes.
class Hostile : public ::testing::Test {
 protected:
  Hostile() { play(); }
  void play() {
    tunnel.on_datagram = [this](bool to_server, PeerId peer, wire::Bytes bytes) {
      const auto opening = wire::parse_opening(bytes);
      // Records are one kind, acknowledgements and feedback alone another.
      const bool is_bare = opening->type == wire::Type::kRecords && (bytes[0] & 16) == 0;
      const auto key = std::pair(to_server, static_cast<int>(opening->type) + (is_bare ? 100 : 0));
      captured.try_emplace(key, Captured{to_server, peer, {bytes.begin(), bytes.end()}});
      return true;
    };
    a = &tunnel.add_house("salsa", {"alice"});
    b = &tunnel.add_house("salsa", {"bob"});
    tunnel.run(Duration::ms(100));
    a->link->send(guest("alice"), average_skeleton(1.6f), tunnel.time_in(*a));
    dance(Duration::ms(300));
    Interest interest;
    ASSERT_TRUE(interest.guests.try_push({guest("bob"), 3}));
    a->link->set_interest(interest, tunnel.time_in(*a));
    dance(Duration::ms(100));
    a->link->set_interest({}, tunnel.time_in(*a));
    auto& c = tunnel.add_house("salsa", {"bob"});  // refused
    dance(Duration::ms(100));
    c.is_running = false;
    auto& d = tunnel.add_house("salsa", {"dora"});
    dance(Duration::ms(100));
    d.link->send_goodbye();
    d.is_running = false;
    dance(Duration::ms(100));
    tunnel.on_datagram = {};
  }

  void dance(Duration duration) {
    tunnel.run(duration, [this] {
      if (tunnel.now().since_zero_us() / 1000 % 16 != 0) return;
      tunnel.dance(*a, guest("alice"));
      tunnel.dance(*b, guest("bob"));
    });
  }

  void inject(const Captured& original, const Bytes& bytes) {
    // Exactly as long as it is, so that a sanitizer sees a read beyond the end.
    const Bytes exact(bytes);
    if (original.to_server)
      tunnel.inject(original.peer, exact);
    else
      a->link->receive(exact, tunnel.time_in(*a), tunnel.time_in(*a));
  }

  // The first record that a sent, to be changed and sent again.
  wire::Record captured_record() const {
    const auto opening = wire::parse_opening(captured.at({true, 18}).bytes);
    ByteReader in(opening->body);
    (void)wire::parse_records_header(in);
    wire::RecordChain chain{tunnel.now().since_zero_us()};
    return *wire::parse_record(chain, in);
  }
  void inject_record(const wire::Record& record) {
    const Captured& original = captured.at({true, 18});
    wire::RecordsHeader header;
    header.has_records = true;
    wire::RecordChain chain{tunnel.now().since_zero_us()};
    Bytes bytes(wire::kMaxPlain);
    ByteWriter out(bytes);
    wire::begin_records(header, out);
    wire::add_record(record, false, chain, out);
    bytes.resize(out.size());
    tunnel.inject(original.peer, bytes);
  }

  void expect_the_dance_goes_on() {
    // What damage made of it, a says anew.
    Interest other;
    other.others = 2;
    a->link->set_interest(other, tunnel.time_in(*a));
    dance(Duration::ms(500));
    a->link->set_interest({}, tunnel.time_in(*a));
    dance(Duration::s(3));
    const auto before_a = a->heard_of(guest("bob"));
    const auto before_b = b->heard_of(guest("alice"));
    dance(Duration::s(1));
    EXPECT_GE(a->heard_of(guest("bob")), before_a + 60);
    EXPECT_GE(b->heard_of(guest("alice")), before_b + 60);
    for (const auto* house : {a, b})
      for (const auto& heard : house->poses) ASSERT_TRUE(is_valid(heard.pose));
  }

  // Here all houses have one key: what it may ask a second is tested by itself.
  SimulatedTunnel tunnel{{.hellos_per_second = 1e6, .hello_burst = 1e6}};
  std::map<std::pair<bool, int>, Captured> captured;
  SimulatedTunnel::House* a = nullptr;
  SimulatedTunnel::House* b = nullptr;
};

TEST_F(Hostile, EveryKindOfDatagramWasSeen) {
  for (const int type : {1, 16, 18, 20, 21, 22, 23})
    EXPECT_TRUE(captured.contains({true, type})) << type;
  for (const int type : {2, 3, 17, 18, 118, 19, 20, 21, 24})
    EXPECT_TRUE(captured.contains({false, type})) << type;
}

TEST_F(Hostile, EveryPrefixOfEveryDatagramIsCountedAndTheDanceGoesOn) {
  for (const auto& [key, original] : captured) {
    if (original.peer == b->peer && !original.to_server) continue;
    for (std::size_t size = 0; size < original.bytes.size(); ++size) {
      if (size == wire::kSessionHeader && key.second == 22) continue;
      const auto rejected = tunnel.server().counters().rejected_total();
      const auto rejected_by_link = a->link->counters().rejected_datagrams;
      inject(original, Bytes(original.bytes.begin(),
                             original.bytes.begin() + static_cast<std::ptrdiff_t>(size)));
      if (original.to_server)
        EXPECT_GT(tunnel.server().counters().rejected_total(), rejected);
      else
        EXPECT_GT(a->link->counters().rejected_datagrams, rejected_by_link);
    }
  }
  expect_the_dance_goes_on();
}

TEST_F(Hostile, EveryFlippedBitOfEveryDatagramLeavesBothSidesSane) {
  for (const auto& [key, original] : captured) {
    Bytes bytes = original.bytes;
    for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
      const auto mask = static_cast<std::uint8_t>(1u << bit % 8);
      bytes[bit / 8] ^= mask;
      inject(original, bytes);
      bytes[bit / 8] ^= mask;
      if (bit % 64 == 0) dance(Duration::ms(1));
    }
  }
  EXPECT_LE(tunnel.server().session_count(), 16u);
  expect_the_dance_goes_on();
}

TEST_F(Hostile, RandomBytesAndRandomBodiesAreDropped) {
  Random random(3);
  for (int i = 0; i < 20'000; ++i) {
    const auto& original =
        std::next(captured.begin(), static_cast<long>(random.below(captured.size())))->second;
    Bytes bytes(random.below(200));
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random.next_u64());
    // Half of them with a true opening, so that the bodies are looked at.
    if (i % 2 == 0)
      std::copy_n(original.bytes.begin(), std::min<std::size_t>(bytes.size(), wire::kSessionHeader),
                  bytes.begin());
    inject(original, bytes);
  }
  expect_the_dance_goes_on();
}

// A hello as a peer of the test's own says it.
class HostileHello : public Hostile {
 protected:
  HostileHello() {
    hello.nonce = 5;
    hello.token = 99;
    EXPECT_TRUE(hello.codecs.try_push(known_codecs().front()));  // what the room speaks
    hello.room = guest("salsa");
    tunnel.on_datagram = [this](bool to_server, PeerId peer, wire::Bytes bytes) {
      if (to_server) return true;
      const auto opening = wire::parse_opening(bytes);
      ++heard[peer];
      if (opening->type == wire::Type::kWelcome) welcome = wire::parse_welcome(opening->body);
      if (opening->type == wire::Type::kRefusal) refusal = wire::parse_refusal(opening->body);
      return true;
    };
  }
  void say_hello(PeerId from) {
    ++hello.link_time_us;
    welcome.reset();
    refusal.reset();
    std::array<std::uint8_t, wire::kMaxHello> bytes;
    tunnel.inject(from, {bytes.data(), wire::build(hello, bytes)});
  }
  void name(const char* who) {
    hello.guests.clear();
    ASSERT_TRUE(hello.guests.try_push(guest(who)));
  }

  wire::Hello hello;
  std::optional<wire::Welcome> welcome;
  std::optional<wire::RefusalNotice> refusal;
  std::map<PeerId, std::size_t> heard;
};

TEST_F(HostileHello, APeerThatSaysNothingMoreIsForgottenAndItsSealedSessionMayComeAgain) {
  const PeerId peer = tunnel.add_peer();
  say_hello(peer);
  ASSERT_TRUE(welcome);
  EXPECT_EQ(tunnel.server().session_count(), 3u);
  dance(Duration::ms(2100));
  EXPECT_EQ(tunnel.server().session_count(), 2u);
  const auto epoch = welcome->epoch;
  std::array<std::uint8_t, 64> ping;
  tunnel.inject(peer, {ping.data(), wire::build(wire::Ping(), ping)});
  EXPECT_EQ(tunnel.server().counters().of(ServerReject::kNoSession), 1u);
  say_hello(peer);
  ASSERT_TRUE(welcome);
  EXPECT_NE(welcome->epoch, epoch);
}

TEST_F(HostileHello, WhatTheSealForgetsIsGoneAtOnce) {
  const PeerId peer = tunnel.add_peer();
  name("carol");
  say_hello(peer);
  EXPECT_EQ(tunnel.server().guest_count(), 3u);
  tunnel.server().forget(peer);
  EXPECT_EQ(tunnel.server().guest_count(), 2u);
  EXPECT_EQ(tunnel.server().session_count(), 2u);
  tunnel.server().forget(peer);
  tunnel.server().forget(4711);
  expect_the_dance_goes_on();
}

// A stolen token must not give the place of the house that it is from.
TEST_F(HostileHello, ATokenIsWorthNothingWithAnotherKey) {
  const PeerId anna = tunnel.add_peer({.name = guest("anna")});
  const PeerId anton = tunnel.add_peer({.name = guest("anton")});
  name("anna");
  say_hello(anna);
  ASSERT_TRUE(welcome);
  say_hello(anton);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->cause, wire::Refusal::kNotAllowedName);
  EXPECT_EQ(refusal->guest, guest("anna"));
  const PeerId any = tunnel.add_peer({.name = guest("room-key"), .any_name = true});
  say_hello(any);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->cause, wire::Refusal::kNameTaken);
  name("anton");
  say_hello(anton);
  ASSERT_TRUE(welcome) << "a session of its own";
  EXPECT_EQ(tunnel.server().session_count(), 4u);
  EXPECT_EQ(tunnel.server().counters().sessions_resumed, 0u);
}

TEST_F(HostileHello, ATokenWithTheSameKeyTakesThePlaceAndTheOldSealedSessionHasNone) {
  const PeerId before = tunnel.add_peer({.name = guest("anna")});
  const PeerId after = tunnel.add_peer({.name = guest("anna")});
  name("anna-2");
  say_hello(before);
  ASSERT_TRUE(welcome);
  const wire::Welcome first = *welcome;
  say_hello(after);
  ASSERT_TRUE(welcome);
  EXPECT_NE(welcome->epoch, first.epoch);
  ASSERT_EQ(welcome->slots.size(), 1u);
  EXPECT_EQ(welcome->slots[0].slot, first.slots[0].slot);
  EXPECT_EQ(welcome->slots[0].generation, first.slots[0].generation);
  EXPECT_EQ(tunnel.server().counters().sessions_resumed, 1u);
  EXPECT_EQ(tunnel.server().session_count(), 3u);
  tunnel.server().forget(before);
  EXPECT_EQ(tunnel.server().session_count(), 3u) << "its place is another's now";
  // A hello that was overtaken by the one after it changes nothing.
  hello.link_time_us -= 2;
  say_hello(before);
  EXPECT_FALSE(welcome || refusal);
  EXPECT_EQ(tunnel.server().counters().of(ServerReject::kOldHello), 1u);
}

TEST_F(HostileHello, AKeyOpensItsRoomAndItsNamesOnly) {
  const PeerId peer = tunnel.add_peer({.name = guest("carol"), .room = guest("salsa")});
  hello.room = guest("tango");
  name("carol");
  say_hello(peer);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->cause, wire::Refusal::kNotAllowedRoom);
  EXPECT_NE(refusal_line(*refusal, hello.room).find("ask the server's keeper"), std::string::npos);
  hello.room = guest("salsa");
  for (const char* other : {"carola", "carl", "dora-carol"}) {
    name(other);
    say_hello(peer);
    ASSERT_TRUE(refusal) << other;
    EXPECT_EQ(refusal->cause, wire::Refusal::kNotAllowedName);
    EXPECT_EQ(refusal->guest, guest(other));
    EXPECT_NE(refusal_line(*refusal, hello.room).find(other), std::string::npos);
  }
  for (const char* own : {"carol", "carol-2"}) {
    name(own);
    say_hello(peer);
    EXPECT_TRUE(welcome) << own;
  }
}

TEST_F(HostileHello, APeerHasOneSessionHoweverManyTokensItHas) {
  const PeerId peer = tunnel.add_peer();
  for (int i = 0; i < 500; ++i) {
    ++hello.token;
    hello.room = guest("room-" + std::to_string(i % 7));
    say_hello(peer);
    ASSERT_TRUE(welcome);
  }
  EXPECT_EQ(tunnel.server().session_count(), 3u);
  EXPECT_EQ(tunnel.server().room_count(), 2u);
  expect_the_dance_goes_on();
}

TEST(HostileHellos, OfOneKeyAreAnsweredSoManyTimesASecond) {
  SimulatedTunnel tunnel;
  tunnel.add_house("salsa", {"alice"});
  tunnel.run(Duration::ms(50));
  wire::Hello hello;
  hello.nonce = 5;
  EXPECT_TRUE(hello.codecs.try_push(known_codecs().front()));
  hello.room = guest("salsa");
  const PeerId peer = tunnel.add_peer();
  std::array<std::uint8_t, wire::kMaxHello> out;
  for (int i = 0; i < 5000; ++i) {
    ++hello.token;
    tunnel.inject(peer, {out.data(), wire::build(hello, out)});
  }
  EXPECT_GT(tunnel.server().counters().of(ServerReject::kSessionRate), 4000u);
  EXPECT_LT(tunnel.server().counters().sessions_begun, 300u);
}

TEST_F(HostileHello, ADatagramWithoutASessionGetsNothingAndAPingAGoodbye) {
  const PeerId peer = tunnel.add_peer();
  const ServerCounters& counters = tunnel.server().counters();
  for (const int type : {18, 16}) tunnel.inject(peer, captured.at({true, type}).bytes);
  EXPECT_EQ(counters.of(ServerReject::kNoSession), 2u);
  EXPECT_EQ(heard[peer], 1u);
}

TEST_F(Hostile, NobodySendsForSomebodyElsesGuest) {
  wire::Record record = captured_record();
  const std::uint8_t own = record.slot;
  for (std::uint8_t slot = 0; slot < wire::kMaxGuestsPerRoom; ++slot) {
    if (slot == own) continue;
    record.slot = slot;
    inject_record(record);
  }
  EXPECT_EQ(tunnel.server().counters().of(ServerReject::kForeignSlot), wire::kMaxGuestsPerRoom - 1);
}

TEST_F(HostileHello, AnotherVersionIsToldSo) {
  hello.version = 99;
  say_hello(tunnel.add_peer());
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->cause, wire::Refusal::kVersion);
  EXPECT_EQ(refusal->nonce, hello.nonce);
  EXPECT_EQ(refusal->server_version, wire::kWireVersion);
  EXPECT_NE(refusal_line(*refusal, guest("salsa")).find("version 6"), std::string::npos);
}

TEST_F(Hostile, AFloodOfOneSessionIsCutToItsRate) {
  const Captured records = captured.at({true, 18});
  const auto in = tunnel.server().counters().datagrams_in;
  for (int i = 0; i < 5000; ++i) tunnel.inject(records.peer, records.bytes);
  EXPECT_EQ(tunnel.server().counters().datagrams_in, in + 5000);
  EXPECT_GE(tunnel.server().counters().of(ServerReject::kSessionRate), 3900u);
  expect_the_dance_goes_on();
}

TEST_F(HostileHello, AFloodOfHellosIsBoundedAndLeavesTheDancersAlone) {
  for (int i = 0; i < 5000; ++i) {
    ++hello.token;
    hello.room = guest("room-" + std::to_string(i % 7));
    say_hello(tunnel.add_peer());
  }
  EXPECT_EQ(tunnel.server().session_count(), 128u) << "half of all: a key that a room shares";
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->cause, wire::Refusal::kKeySessions);
  expect_the_dance_goes_on();
  EXPECT_EQ(tunnel.server().session_count(), 2u);
}

TEST_F(Hostile, CaptureTimesFromNowhereAreRefused) {
  wire::Record record = captured_record();
  const std::int64_t now_us = tunnel.now().since_zero_us();
  for (const std::int64_t extreme :
       {std::int64_t{0}, INT64_MIN + 64, now_us - 61'000'000, now_us + 1'001'000}) {
    record.capture_us = extreme;
    inject_record(record);
  }
  EXPECT_EQ(tunnel.server().counters().of(ServerReject::kBadTime), 3u);
  EXPECT_EQ(tunnel.server().counters().of(ServerReject::kMalformed), 1u)
      << "too far to reckon with";
}

}  // namespace
}  // namespace dance

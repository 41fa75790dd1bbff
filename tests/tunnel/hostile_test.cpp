// What strangers and damage can do to a server and to a link: be counted, and nothing else.
#include <gtest/gtest.h>

#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Captured {
  bool to_server;
  Address peer;
  Bytes bytes;
};

// A dancing pair with hands, skeletons, a late joiner and a goodbye: every kind of datagram passes.
class Hostile : public ::testing::Test {
 protected:
  Hostile() {
    tunnel.on_datagram = [this](bool to_server, const Address& peer, wire::Bytes bytes) {
      const auto opening = wire::parse_opening(bytes);
      // Records are one kind, acknowledgements and feedback alone another.
      const bool is_bare =
          opening->type == wire::Type::kRecords && (bytes[wire::kSessionHeader + 2] & 16) == 0;
      const auto key = std::pair(to_server, static_cast<int>(opening->type) + (is_bare ? 100 : 0));
      captured.try_emplace(key, Captured{to_server, peer, {bytes.begin(), bytes.end()}});
      return true;
    };
    a = &tunnel.add_house("salsa", {"alice"});
    b = &tunnel.add_house("salsa", {"bob"});
    tunnel.run(Duration::ms(100));
    a->link->send(guest("alice"), average_skeleton(1.6f), tunnel.time_in(*a));
    dance(Duration::ms(300));
    auto& c = tunnel.add_house("salsa", {"bob"});  // refused
    dance(Duration::ms(100));
    c.is_running = false;
    auto& d = tunnel.add_house("salsa", {"dora"});
    dance(Duration::ms(100));
    d.link->say_goodbye();
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
    const auto header = wire::parse_records_header(in);
    return *wire::parse_record(wire::base_us(header->base_ticks, tunnel.now().since_zero_us()), in);
  }
  void inject_record(const wire::Record& record) {
    const Captured& original = captured.at({true, 18});
    wire::RecordsHeader header;
    header.has_records = true;
    header.base_ticks = wire::to_ticks(tunnel.now().since_zero_us());
    Bytes bytes(wire::kMaxDatagram);
    ByteWriter out(bytes);
    wire::begin_records(wire::parse_opening(original.bytes)->session, header, out);
    wire::add_record(record, false, header.base_ticks, out);
    bytes.resize(out.size());
    tunnel.inject(original.peer, bytes);
  }

  void expect_the_dance_goes_on() {
    dance(Duration::s(3));
    const auto before_a = a->heard_of(guest("bob"));
    const auto before_b = b->heard_of(guest("alice"));
    dance(Duration::s(1));
    EXPECT_GE(a->heard_of(guest("bob")), before_a + 60);
    EXPECT_GE(b->heard_of(guest("alice")), before_b + 60);
    for (const auto* house : {a, b})
      for (const auto& heard : house->poses) ASSERT_TRUE(is_valid(heard.pose));
  }

  SimulatedTunnel tunnel;
  std::map<std::pair<bool, int>, Captured> captured;
  SimulatedTunnel::House* a = nullptr;
  SimulatedTunnel::House* b = nullptr;
};

TEST_F(Hostile, EveryKindOfDatagramWasSeen) {
  for (const int type : {1, 16, 18, 20, 21, 22})
    EXPECT_TRUE(captured.contains({true, type})) << type;
  for (const int type : {2, 3, 17, 18, 118, 19, 20, 21})
    EXPECT_TRUE(captured.contains({false, type})) << type;
}

TEST_F(Hostile, EveryPrefixOfEveryDatagramIsCountedAndTheDanceGoesOn) {
  for (const auto& [key, original] : captured) {
    if (original.peer == b->address && !original.to_server) continue;
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

TEST_F(Hostile, AStrangersHelloIsAnsweredOnlyOnceAndNeverWithMoreThanItSent) {
  std::size_t answered = 0;
  tunnel.on_datagram = [&](bool to_server, const Address& peer, wire::Bytes bytes) {
    if (!to_server && peer == Address::loopback(6666)) {
      ++answered;
      EXPECT_LE(bytes.size(), wire::kHelloBytes);
    }
    return true;
  };
  const Captured hello = captured.at({true, 1});
  Bytes bytes = hello.bytes;
  bytes[16] ^= 1;                          // another token
  bytes[8 + 8 + 8 + 8 + 1 + 5 + 1] = 'x';  // another room: no name is taken there
  tunnel.inject(Address::loopback(6666), bytes);
  EXPECT_EQ(answered, 1u);
  dance(Duration::ms(900));
  EXPECT_EQ(answered, 1u) << "nothing goes to an address that has not proved itself";
  dance(Duration::ms(300));
  EXPECT_EQ(tunnel.server().room_count(), 1u) << "an unproven session lasts a second";
}

// Whoever learnt a session's id at one address must not be able to prove another with it: else a server sends a whole
// room's dance to somebody who never asked.
TEST_F(Hostile, AKnownSessionIdDoesNotProveAnAddressThatNeverAsked) {
  const Address attacker = Address::loopback(6666), victim = Address::loopback(7777);
  std::uint64_t id = 0;
  std::size_t to_victim = 0;
  tunnel.on_datagram = [&](bool to_server, const Address& peer, wire::Bytes bytes) {
    const auto opening = wire::parse_opening(bytes);
    if (!to_server && peer == attacker && opening->type == wire::Type::kWelcome)
      id = wire::parse_welcome(*opening)->session;
    if (!to_server && peer == victim) {
      ++to_victim;
      EXPECT_TRUE(opening->type == wire::Type::kWelcome ||
                  opening->type == wire::Type::kUnknownSession);
    }
    return true;
  };
  wire::Hello hello;
  hello.nonce = 5;
  hello.token = 99;
  hello.link_time_us = 1;
  ASSERT_TRUE(hello.codecs.try_push(known_codecs().front()));  // what the room speaks
  hello.room = *wire::RoomName::parse("salsa");
  std::array<std::uint8_t, wire::kHelloBytes> bytes;
  const auto say_hello = [&](const Address& from) {
    ++hello.link_time_us;
    tunnel.inject(from, {bytes.data(), wire::build(hello, bytes)});
  };
  const auto ping = [&](const Address& from) {
    std::array<std::uint8_t, 64> out;
    tunnel.inject(from, {out.data(), wire::build(id, wire::Ping(), out)});
  };
  say_hello(attacker);
  ASSERT_NE(id, 0u);
  ping(attacker);
  say_hello(victim);
  for (int i = 0; i < 5; ++i) {
    ping(victim);
    dance(Duration::ms(100));
  }
  EXPECT_LE(to_victim, 6u) << "the welcome, and one short answer to each ping";
}

TEST_F(Hostile, HellosAloneDoNotKeepAPlace) {
  wire::Hello hello;
  hello.token = 99;
  hello.nonce = 5;
  ASSERT_TRUE(hello.codecs.try_push({CodecId::kPlain, 0}));
  hello.room = *wire::RoomName::parse("tango");
  std::array<std::uint8_t, wire::kHelloBytes> bytes;
  for (int i = 1; i <= 15; ++i) {
    hello.link_time_us = i;
    tunnel.inject(Address::loopback(6666), {bytes.data(), wire::build(hello, bytes)});
    dance(Duration::ms(90));
  }
  EXPECT_GE(tunnel.server().counters().sessions_timed_out, 1u);
}

TEST_F(Hostile, AShortHelloIsNotAnswered) {
  std::size_t answered = 0;
  tunnel.on_datagram = [&](bool to_server, const Address&, wire::Bytes) {
    answered += to_server ? 0 : 1;
    return true;
  };
  Bytes bytes = captured.at({true, 1}).bytes;
  bytes.resize(wire::kHelloBytes - 1);
  tunnel.inject(Address::loopback(6666), bytes);
  EXPECT_EQ(answered, 0u);
  EXPECT_GE(tunnel.server().counters().of(ServerReject::kTooShort), 1u);
}

TEST_F(Hostile, ASessionIdFromAnotherAddressGetsNothing) {
  const Captured records = captured.at({true, 18});
  const auto in = tunnel.server().counters().records_in;
  tunnel.inject(Address::loopback(6666), records.bytes);
  EXPECT_EQ(tunnel.server().counters().records_in, in);
  EXPECT_EQ(tunnel.server().counters().of(ServerReject::kWrongAddress), 1u);
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

TEST_F(Hostile, ACopyOfAnOldHelloDoesNotMoveASession) {
  dance(Duration::ms(1100));
  a->is_cut = true;
  dance(Duration::ms(1500));  // says hello again, which is lost
  a->is_cut = false;
  dance(Duration::ms(700));
  ASSERT_TRUE(a->link->is_connected());
  const auto resumed = tunnel.server().counters().sessions_resumed;
  tunnel.inject(Address::loopback(6666), captured.at({true, 1}).bytes);
  EXPECT_GE(tunnel.server().counters().of(ServerReject::kOldHello), 1u);
  EXPECT_EQ(tunnel.server().counters().sessions_resumed, resumed);
}

TEST_F(Hostile, AnotherVersionIsToldSo) {
  Bytes bytes = captured.at({true, 1}).bytes;
  bytes[4] = 99;
  std::optional<wire::RefusalNotice> answer;
  tunnel.on_datagram = [&](bool, const Address&, wire::Bytes out) {
    answer = wire::parse_refusal(*wire::parse_opening(out));
    return true;
  };
  tunnel.inject(Address::loopback(6666), bytes);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->cause, wire::Refusal::kVersion);
  EXPECT_EQ(answer->server_version, wire::kWireVersion);
  EXPECT_NE(refusal_line(*answer, guest("salsa")).find("version 2"), std::string::npos);
}

TEST_F(Hostile, AFloodOfOneSessionIsCutToItsRate) {
  const Captured records = captured.at({true, 18});
  const auto in = tunnel.server().counters().datagrams_in;
  for (int i = 0; i < 5000; ++i) tunnel.inject(records.peer, records.bytes);
  EXPECT_EQ(tunnel.server().counters().datagrams_in, in + 5000);
  EXPECT_GE(tunnel.server().counters().of(ServerReject::kSessionRate), 3900u);
  expect_the_dance_goes_on();
}

TEST_F(Hostile, AFloodOfHellosIsBoundedAndLeavesTheDancersAlone) {
  Bytes bytes = captured.at({true, 1}).bytes;
  bytes[8 + 8 + 8 + 8 + 1 + 5 + 1] = 'x';
  for (int i = 0; i < 5000; ++i) {
    bytes[16] = static_cast<std::uint8_t>(i);
    bytes[17] = static_cast<std::uint8_t>(i >> 8);
    tunnel.inject(Address::loopback(static_cast<std::uint16_t>(30'000 + i)), bytes);
  }
  EXPECT_LE(tunnel.server().session_count(), 256u);
  EXPECT_GE(tunnel.server().counters().of(ServerReject::kStrangerRate), 4700u);
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
  EXPECT_EQ(tunnel.server().counters().of(ServerReject::kBadTime), 4u);
}

}  // namespace
}  // namespace dance

// Wire format 5 has twice the slots of 4: who speaks 4 goes on, with the lower half.
#include <gtest/gtest.h>

#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

struct Heard {
  std::optional<wire::Welcome> welcome;
  std::optional<wire::RefusalNotice> refusal;
  std::vector<wire::RosterPart> roster;
};

// What the server says to a peer that says hello in this version.
Heard hello_of(std::uint8_t version) {
  SimulatedTunnel tunnel;
  Heard heard;
  const PeerId peer = tunnel.add_peer();
  tunnel.on_datagram = [&](bool to_server, PeerId to, wire::Bytes bytes) {
    if (to_server || to != peer) return true;
    const auto opening = wire::parse_opening(bytes);
    EXPECT_TRUE(opening);
    if (opening->type == wire::Type::kWelcome) heard.welcome = wire::parse_welcome(opening->body);
    if (opening->type == wire::Type::kRefusal) heard.refusal = wire::parse_refusal(opening->body);
    if (opening->type == wire::Type::kRoster)
      heard.roster.push_back(*wire::parse_roster(opening->body));
    return true;
  };
  wire::Hello hello;
  hello.version = version;
  hello.nonce = 7;
  hello.token = 8;
  EXPECT_TRUE(hello.codecs.try_push(known_codecs().front()));
  hello.room = guest("salsa");
  EXPECT_TRUE(hello.guests.try_push(guest("alice")));
  std::array<std::uint8_t, wire::kMaxHello> out;
  tunnel.inject(peer, {out.data(), wire::build(hello, out)});
  return heard;
}

TEST(WireVersion, EachIsAnsweredInItsOwn) {
  const Heard five = hello_of(5), four = hello_of(4);
  ASSERT_TRUE(five.welcome);
  ASSERT_TRUE(four.welcome);
  EXPECT_EQ(five.welcome->version, 5);
  EXPECT_EQ(four.welcome->version, 4);
  ASSERT_EQ(five.roster.size(), 4u);
  ASSERT_EQ(four.roster.size(), 2u) << "as many slots as it knows";
  EXPECT_EQ(four.roster[0].parts, 2);
}

TEST(WireVersion, OthersAreRefusedWithWhatIsSpoken) {
  for (const std::uint8_t version : {std::uint8_t{3}, std::uint8_t{6}}) {
    const Heard heard = hello_of(version);
    EXPECT_FALSE(heard.welcome);
    ASSERT_TRUE(heard.refusal);
    EXPECT_EQ(heard.refusal->cause, wire::Refusal::kVersion);
    EXPECT_EQ(heard.refusal->server_version, wire::kWireVersion);
  }
}

// An older link and an older server, of which the test plays the answer.
TEST(WireVersion, ALinkSpeaksAsTheServerDoes) {
  struct Sink final : DatagramSink {
    void send(const Address&, std::span<const std::uint8_t> bytes) override {
      wire::HelloProblem problem;
      const auto opening = wire::parse_opening(bytes);
      if (opening && opening->type == wire::Type::kHello)
        hellos.push_back(*wire::parse_hello(opening->body, problem));
    }
    std::vector<wire::Hello> hellos;
  } sink;
  LinkOptions options;
  options.room = guest("salsa");
  options.token = 5;
  ASSERT_TRUE(options.guests.try_push(guest("alice")));
  int refusals_told = 0;
  LinkHandlers handlers;
  handlers.on_refused = [&](const wire::RefusalNotice&, MonoTime) { ++refusals_told; };
  LinkCore link(options, handlers, sink);
  MonoTime now = MonoTime::from_us(1'000'000);
  link.on_sealed(now);
  link.tick(now);
  ASSERT_EQ(sink.hellos.size(), 1u);
  EXPECT_EQ(sink.hellos[0].version, 5);
  const auto refuse = [&](std::uint8_t server_version) {
    wire::RefusalNotice notice;
    notice.server_version = server_version;
    notice.nonce = sink.hellos.back().nonce;
    std::array<std::uint8_t, 64> out;
    link.receive({out.data(), wire::build(notice, out)}, now, now);
    link.tick(now);
  };
  refuse(4);
  ASSERT_EQ(sink.hellos.size(), 2u) << "at once";
  EXPECT_EQ(sink.hellos[1].version, 4);
  EXPECT_EQ(refusals_told, 0);
  // The next server may be a newer one again.
  now += Duration::s(1);
  link.on_sealed(now);
  link.tick(now);
  EXPECT_EQ(sink.hellos.back().version, 5);
  refuse(3);
  EXPECT_EQ(refusals_told, 1) << "that is too old";
}

}  // namespace
}  // namespace dance

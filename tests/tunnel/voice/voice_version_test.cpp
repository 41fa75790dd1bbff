// Peers of version 4 know no voices: none is sent to them, and they send none.
#include <gtest/gtest.h>

#include "tests/tunnel/voice/voices.h"

namespace dance {
namespace {

TEST(VoiceVersion, AServerSendsNoneToALinkOfVersionFour) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(200));
  const PeerId old = tunnel.add_peer();
  std::size_t others = 0, voices = 0;
  tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    if (to_server || peer != old) return true;
    ++(wire::parse_opening(bytes)->type == wire::Type::kVoices ? voices : others);
    return true;
  };
  wire::Hello hello;
  hello.version = 4;
  hello.token = 77;
  ASSERT_TRUE(hello.codecs.try_push(known_codecs().back()));
  ASSERT_TRUE(hello.codecs.try_push(known_codecs().front()));
  hello.room = guest("salsa");
  std::array<std::uint8_t, wire::kMaxHello> out;
  tunnel.inject(old, {out.data(), wire::build(hello, out)});
  Talk talk{tunnel, {{&a, guest("alice")}}};
  talk.run(Duration::ms(500));
  tunnel.dance(a, guest("alice"));
  tunnel.run(Duration::ms(50));
  EXPECT_GT(others, 0u);
  EXPECT_EQ(voices, 0u);
  EXPECT_EQ(b.voices.size(), 50u);
  // Nor does it take one from it.
  const std::uint8_t one[] = {30, 9, 9};
  tunnel.inject(old, one);
  EXPECT_EQ(tunnel.server().counters().of(ServerReject::kUnknownType), 1u);
}

// An older server, whose answers the test makes.
TEST(VoiceVersion, ALinkSendsNoneToAServerOfVersionFour) {
  struct Sink final : DatagramSink {
    void send(const Address&, std::span<const std::uint8_t> bytes) override {
      const auto opening = wire::parse_opening(bytes);
      wire::HelloProblem problem;
      if (opening->type == wire::Type::kHello) hello = *wire::parse_hello(opening->body, problem);
      voices += opening->type == wire::Type::kVoices ? 1 : 0;
      if (opening->type == wire::Type::kInterest) interest.emplace(bytes.begin(), bytes.end());
    }
    wire::Hello hello;
    std::size_t voices = 0;
    std::optional<std::vector<std::uint8_t>> interest;
  };
  for (const std::uint8_t version : {std::uint8_t{4}, std::uint8_t{5}}) {
    Sink sink;
    LinkOptions options;
    options.room = guest("salsa");
    options.token = 5;
    options.clock_id = 8;
    options.hearing = hearing({"default=0"});
    ASSERT_TRUE(options.guests.try_push(guest("alice")));
    LinkCore link(options, {}, sink);
    const MonoTime now = MonoTime::from_us(1'000'000'000);
    link.on_sealed(now);
    link.tick(now);
    wire::Welcome welcome;
    welcome.version = version;
    welcome.nonce = sink.hello.nonce;
    welcome.epoch = 3;
    welcome.link_time_us = sink.hello.link_time_us;
    welcome.codec = sink.hello.codecs[0];
    ASSERT_TRUE(welcome.slots.try_push({0, 1}));
    std::array<std::uint8_t, wire::kMaxHello> out;
    link.receive({out.data(), wire::build(welcome, out)}, now, now);
    ASSERT_TRUE(link.is_connected());
    wire::RosterPart roster;
    roster.version = 1;
    link.receive({out.data(), wire::build(roster, out)}, now, now);
    link.send(guest("alice"), voice_number(1, now, 8), now);
    link.tick(now);
    EXPECT_EQ(sink.voices, version == 4 ? 0u : 1u);
    EXPECT_EQ(link.counters().voices_unrouted, version == 4 ? 1u : 0u);
    EXPECT_EQ(sink.interest.has_value(), version == 5) << "and does not speak of voices to it";
  }
}

}  // namespace
}  // namespace dance

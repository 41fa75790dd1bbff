// A server answers one version of the wire format, and refuses others with the number of its own.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/tunnel/voice/voices.h"

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

TEST(WireVersion, AHelloOfThisVersionIsWelcomeAndGetsTheWholeRoster) {
  const Heard heard = hello_of(wire::kWireVersion);
  ASSERT_TRUE(heard.welcome);
  EXPECT_EQ(heard.welcome->version, wire::kWireVersion);
  ASSERT_EQ(heard.roster.size(), 4u);
  EXPECT_EQ(heard.roster[0].parts, 4);
}

TEST(WireVersion, OtherVersionsGetARefusalWithTheServersVersion) {
  for (const std::uint8_t version : {std::uint8_t{5}, std::uint8_t{7}}) {
    const Heard heard = hello_of(version);
    EXPECT_FALSE(heard.welcome);
    ASSERT_TRUE(heard.refusal);
    EXPECT_EQ(heard.refusal->cause, wire::Refusal::kVersion);
    EXPECT_EQ(heard.refusal->server_version, wire::kWireVersion);
  }
}

// A link, and the answers of a server, which the test makes.
class LinkOfOneVersion : public testing::Test, public DatagramSink {
 protected:
  LinkOfOneVersion() {
    LinkOptions options;
    options.room = guest("salsa");
    options.token = 5;
    options.clock_id = 8;
    options.hearing = hearing({"default=0"});
    EXPECT_TRUE(options.guests.try_push(guest("alice")));
    LinkHandlers handlers;
    handlers.on_refused = [this](const wire::RefusalNotice& notice, MonoTime) {
      refused_.push_back(notice.cause);
    };
    link_ = std::make_unique<LinkCore>(options, handlers, *this);
    link_->on_sealed(now_);
    link_->tick(now_);
  }
  void send(const Address&, std::span<const std::uint8_t> bytes) override {
    wire::HelloProblem problem;
    const auto opening = wire::parse_opening(bytes);
    ASSERT_TRUE(opening);
    if (opening->type == wire::Type::kHello)
      hellos_.push_back(*wire::parse_hello(opening->body, problem));
    voices_ += opening->type == wire::Type::kVoices ? 1 : 0;
    has_interest_ |= opening->type == wire::Type::kInterest;
  }
  template <class Message>
  void receive(const Message& message) {
    std::array<std::uint8_t, wire::kMaxHello> out;
    link_->receive({out.data(), wire::build(message, out)}, now_, now_);
  }
  wire::Welcome welcome() const {
    wire::Welcome welcome;
    welcome.nonce = hellos_.back().nonce;
    welcome.epoch = 3;
    welcome.link_time_us = hellos_.back().link_time_us;
    welcome.codec = hellos_.back().codecs[0];
    EXPECT_TRUE(welcome.slots.try_push({0, 1}));
    return welcome;
  }

  MonoTime now_ = MonoTime::from_us(1'000'000'000);
  std::unique_ptr<LinkCore> link_;
  std::vector<wire::Hello> hellos_;
  std::vector<wire::Refusal> refused_;
  int voices_ = 0;
  bool has_interest_ = false;
};

TEST_F(LinkOfOneVersion, ReportsAServerOfAnotherVersionAndKeepsItsOwn) {
  ASSERT_EQ(hellos_.size(), 1u);
  EXPECT_EQ(hellos_[0].version, wire::kWireVersion);
  wire::RefusalNotice notice;
  notice.server_version = wire::kWireVersion - 1;
  notice.nonce = hellos_[0].nonce;
  receive(notice);
  link_->tick(now_);
  EXPECT_EQ(refused_, std::vector{wire::Refusal::kVersion});
  EXPECT_EQ(hellos_.size(), 1u) << "not at once";
  now_ += Duration::s(30);
  link_->tick(now_);
  ASSERT_GT(hellos_.size(), 1u);
  EXPECT_EQ(hellos_.back().version, wire::kWireVersion);
}

TEST_F(LinkOfOneVersion, IgnoresAWelcomeOfAnotherVersion) {
  wire::Welcome other = welcome();
  other.version = wire::kWireVersion - 1;
  receive(other);
  EXPECT_FALSE(link_->is_connected());
}

TEST_F(LinkOfOneVersion, SendsItsVoiceAndItsHearingOnceItIsWelcome) {
  receive(welcome());
  ASSERT_TRUE(link_->is_connected());
  wire::RosterPart roster;
  roster.version = 1;
  receive(roster);
  link_->send(guest("alice"), voice_number(1, now_, 8), now_);
  link_->tick(now_);
  EXPECT_EQ(voices_, 1);
  EXPECT_EQ(link_->counters().voices_unrouted, 0u);
  EXPECT_TRUE(has_interest_);
}

}  // namespace
}  // namespace dance

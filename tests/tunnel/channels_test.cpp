// Further channels through links and server: only what rules let pass, and nothing of it in the way
// of poses or of each other.
#include <gtest/gtest.h>

#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;
using Bytes = std::vector<std::uint8_t>;

// A fingerprint, a count, and as many doubles.
Bytes arm(std::uint8_t joints, std::uint8_t value = 0) {
  Bytes bytes(8 + 4 + 8u * joints, value);
  bytes[8] = bytes[9] = bytes[10] = 0;
  bytes[11] = joints;
  return bytes;
}

class Channels : public ::testing::Test {
 protected:
  House& add_house(const std::string& name, const std::vector<std::string>& rules) {
    tunnel.link_options.channels.clear();
    for (const std::string& line : rules) {
      const auto rule = ChannelRule::parse(line);
      EXPECT_TRUE(rule) << rule.error().what;
      tunnel.link_options.channels.push_back(*rule);
    }
    House& house = tunnel.add_house("salsa", {name});
    tunnel.run(Duration::ms(50));
    return house;
  }
  void send(House& house, std::string_view channel, const Bytes& bytes) {
    house.link->send_channel(channel, bytes, tunnel.time_in(house));
  }
  static std::size_t heard(const House& house, std::string_view name) {
    return static_cast<std::size_t>(
        std::count_if(house.channels.begin(), house.channels.end(),
                      [&](const auto& message) { return message.name == name; }));
  }
  static Bytes last(const House& house, std::string_view name) {
    Bytes bytes;
    for (const auto& message : house.channels)
      if (message.name == name) bytes = message.bytes;
    return bytes;
  }

  SimulatedTunnel tunnel;
  Random random{37};
};

constexpr const char* kDesk = "LIGHT/desk class=state size=100 rate=20 layout=n:i32,f64[n]";
constexpr const char* kArm = "ROBOT/arm class=newest size=100 rate=60 layout=n:i32,f64[n]";
constexpr const char* kAllArms = "ROBOT/* class=newest size=100 rate=60 layout=n:i32,f64[n]";

TEST_F(Channels, AStateReachesThoseWhoComeLate) {
  House& a = add_house("alice", {kDesk});
  send(a, "LIGHT/desk", arm(2, 5));
  tunnel.run(Duration::ms(100));
  House& b = add_house("bob", {kDesk});
  ASSERT_EQ(heard(b, "LIGHT/desk"), 1u);
  EXPECT_EQ(b.channels[0].guest, guest("alice"));
  EXPECT_EQ(b.channels[0].bytes, arm(2, 5));
  send(a, "LIGHT/desk", arm(2, 5));  // nothing new
  tunnel.run(Duration::ms(100));
  EXPECT_EQ(heard(b, "LIGHT/desk"), 1u);
  send(a, "LIGHT/desk", arm(3, 6));
  tunnel.run(Duration::ms(100));
  EXPECT_EQ(last(b, "LIGHT/desk"), arm(3, 6));
  EXPECT_TRUE(a.channels.empty()) << "one's own does not come back";
}

TEST_F(Channels, AStateThatWasSaidBeforeThereWasASessionIsNotLost) {
  House& b = add_house("bob", {kDesk});
  tunnel.link_options.channels = {*ChannelRule::parse(kDesk)};
  House& a = tunnel.add_house("salsa", {"alice"});
  send(a, "LIGHT/desk", arm(1, 9));
  tunnel.run(Duration::ms(300));
  EXPECT_EQ(last(b, "LIGHT/desk"), arm(1, 9));
}

// More than goes out at once: the rest follows with the pongs, and none of it is told twice.
TEST_F(Channels, ARoomFullOfStatesReachesALateJoinerInPieces) {
  constexpr const char* kAll = "X/* class=state rate=20 layout=any unchecked=yes";
  constexpr std::size_t kHouses = 25;
  for (std::size_t i = 0; i < kHouses; ++i) {
    House& house = add_house("guest-" + std::to_string(i), {kAll});
    for (std::size_t k = 0; k < kMaxChannelsPerGuest; ++k)
      send(house, "X/" + std::to_string(k), Bytes(kMaxChannelStateBytes, 7));
  }
  tunnel.run(Duration::s(1));
  House& late = tunnel.add_house("salsa", {"late"});
  tunnel.run(Duration::ms(12));
  EXPECT_GT(late.channels.size(), 100u);
  EXPECT_LT(late.channels.size(), kHouses * kMaxChannelsPerGuest);
  tunnel.run(Duration::s(1));
  EXPECT_EQ(late.channels.size(), kHouses * kMaxChannelsPerGuest);
}

TEST_F(Channels, AFastStateConvergesOnItsNewestWithinItsRate) {
  House& a = add_house("alice", {"LIGHT/desk class=state rate=4 layout=n:i32,f64[n]"});
  House& b = add_house("bob", {kDesk});
  for (std::uint8_t i = 1; i <= 200; ++i) {
    send(a, "LIGHT/desk", arm(1, i));
    tunnel.run(Duration::ms(10));
  }
  EXPECT_LE(heard(b, "LIGHT/desk"), 4u * 2 + 2);
  EXPECT_GT(a.link->counters().channels_limited, 100u);
  tunnel.run(Duration::s(1));
  EXPECT_EQ(last(b, "LIGHT/desk"), arm(1, 200));
}

TEST_F(Channels, AFastStateIsHeldToTheHearersRateToo) {
  House& a = add_house("alice", {kDesk});
  House& b = add_house("bob", {"LIGHT/desk class=state rate=1 layout=n:i32,f64[n]"});
  for (std::uint8_t i = 1; i <= 40; ++i) {
    send(a, "LIGHT/desk", arm(1, i));
    tunnel.run(Duration::ms(100));
  }
  EXPECT_LE(heard(b, "LIGHT/desk"), 6u);
  tunnel.run(Duration::s(3));
  EXPECT_EQ(last(b, "LIGHT/desk"), arm(1, 40));
}

TEST_F(Channels, ThirtyPercentLossConvergesOnTheNewest) {
  House& a = add_house("alice", {kDesk});
  House& b = add_house("bob", {kDesk});
  tunnel.on_datagram = [&](bool, PeerId, wire::Bytes) { return random.uniform() >= 0.3; };
  for (std::uint8_t i = 1; i <= 50; ++i) {
    send(a, "LIGHT/desk", arm(1, i));
    tunnel.run(Duration::ms(60));
  }
  tunnel.run(Duration::s(5));
  EXPECT_EQ(last(b, "LIGHT/desk"), arm(1, 50));
}

TEST_F(Channels, AStreamComesNewestFirstAndEachByItself) {
  House& a = add_house("alice", {kAllArms});
  House& b = add_house("bob", {kAllArms});
  send(a, "ROBOT/left", arm(1));
  send(a, "ROBOT/right", arm(1));
  tunnel.run(Duration::ms(100));
  const std::size_t before = b.channels.size();
  // The line turns the order about: what is late of one channel goes, and takes nothing of another.
  std::uint8_t n = 0;
  tunnel.run(Duration::s(1), [&] {
    if (tunnel.now().since_zero_us() / 1000 % 25 != 0) return;
    ++n;
    a.up = n % 2 == 0 ? Duration::ms(5) : Duration::ms(40);
    send(a, n % 2 == 0 ? "ROBOT/left" : "ROBOT/right", arm(1, n));
  });
  tunnel.run(Duration::ms(100));
  EXPECT_EQ(b.channels.size() - before, 40u);
  EXPECT_EQ(b.link->counters().channels_late, 0u);
  a.up = Duration::ms(60);
  send(a, "ROBOT/left", arm(1, 101));
  tunnel.run(Duration::ms(10));
  a.up = Duration::ms(5);
  send(a, "ROBOT/left", arm(1, 102));
  tunnel.run(Duration::ms(100));
  EXPECT_EQ(last(b, "ROBOT/left"), arm(1, 102));
  EXPECT_EQ(tunnel.server().counters().of(ServerReject::kLate), 1u);
}

TEST_F(Channels, OnlyWhatTheHearersOwnListNamesComesIn) {
  House& a = add_house("alice", {kArm, kDesk, "X/y class=newest layout=any unchecked=yes"});
  House& other_name = add_house("bob", {"ROBOT/hand class=newest layout=n:i32,f64[n]"});
  House& other_layout = add_house("carol", {"ROBOT/arm class=newest layout=i64"});
  House& other_class = add_house("dora", {"ROBOT/arm class=state layout=n:i32,f64[n]"});
  House& smaller = add_house("emma", {"ROBOT/arm class=newest size=20 layout=n:i32,f64[n]"});
  House& only_out = add_house("fred", {std::string(kArm) + " direction=out"});
  House& nothing = add_house("gina", {});
  House& same = add_house("hugo", {kArm});
  for (int i = 0; i < 10; ++i) {
    send(a, "ROBOT/arm", arm(2));
    send(a, "X/y", {1, 2, 3});
    send(a, "LIGHT/desk", arm(1, static_cast<std::uint8_t>(i)));
    tunnel.run(Duration::ms(50));
  }
  for (const House* house :
       {&other_name, &other_layout, &other_class, &smaller, &only_out, &nothing}) {
    EXPECT_TRUE(house->channels.empty());
    const LinkCounters& c = house->link->counters();
    EXPECT_GE(c.channels_unlisted + c.channels_invalid, 20u) << "all that was kept out is counted";
  }
  EXPECT_EQ(heard(same, "ROBOT/arm"), 10u);
  EXPECT_EQ(same.channels.size(), 10u);
}

TEST_F(Channels, NothingLeavesThatTheOwnListDoesNotName) {
  House& a = add_house("alice", {kArm, "IN/only class=newest layout=i64 direction=in"});
  House& b = add_house("bob", {"ROBOT/* class=newest layout=any unchecked=yes",
                               "IN/* class=newest layout=any unchecked=yes"});
  send(a, "ROBOT/leg", arm(1));
  send(a, "IN/only", Bytes(16));
  send(a, "POSE/stage/alice", Bytes(16));
  send(a, "ROBOT/arm/guest/bob", arm(1));
  EXPECT_EQ(a.link->counters().channels_unlisted, 4u);
  send(a, "ROBOT/arm", arm(12));  // 108 bytes
  send(a, "ROBOT/arm", Bytes(9, 1));
  send(a, "ROBOT/arm", {});
  EXPECT_EQ(a.link->counters().channels_invalid, 3u);
  tunnel.run(Duration::ms(100));
  EXPECT_TRUE(b.channels.empty());
  EXPECT_EQ(tunnel.server().counters().records_in, 0u);
}

TEST_F(Channels, ABroadRuleLetsNoMoreThanEightOfThem) {
  House& a = add_house("alice", {kAllArms});
  House& b = add_house("bob", {kAllArms});
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i < 50; ++i) send(a, "ROBOT/" + std::to_string(i), arm(1));
    tunnel.run(Duration::ms(50));
  }
  std::map<std::string, int> names;
  for (const auto& message : b.channels) ++names[message.name];
  EXPECT_EQ(names.size(), kMaxChannelsPerGuest);
  EXPECT_GT(a.link->counters().channels_overflow, 0u);
}

TEST_F(Channels, ARuleMaySayWhichGuestSends) {
  tunnel.link_options.channels = {*ChannelRule::parse(std::string(kArm) + " guest=ben"),
                                  *ChannelRule::parse(std::string(kDesk) + " guest=nobody")};
  House& a = tunnel.add_house("salsa", {"anna", "ben"});
  tunnel.run(Duration::ms(50));
  House& b = add_house("bob", {kArm, kDesk});
  send(a, "ROBOT/arm", arm(1));
  send(a, "LIGHT/desk", arm(1));
  tunnel.run(Duration::ms(100));
  ASSERT_EQ(b.channels.size(), 1u);
  EXPECT_EQ(b.channels[0].guest, guest("ben"));
}

TEST_F(Channels, TheRateHoldsAtTheSender) {
  House& a = add_house("alice", {"ROBOT/arm class=newest rate=20 layout=n:i32,f64[n]"});
  House& b = add_house("bob", {"ROBOT/arm class=newest rate=240 layout=n:i32,f64[n]"});
  tunnel.run(Duration::s(2), [&] { send(a, "ROBOT/arm", arm(1)); });
  tunnel.run(Duration::ms(50));
  EXPECT_LE(b.channels.size(), 46u);
  EXPECT_GE(b.channels.size(), 38u);
  EXPECT_EQ(a.link->counters().channels_sent, b.channels.size());
  EXPECT_EQ(a.link->counters().channels_limited, 2000u - b.channels.size());
}

TEST_F(Channels, AndAtTheHearer) {
  House& a = add_house("alice", {"ROBOT/arm class=newest rate=240 layout=n:i32,f64[n]"});
  House& b = add_house("bob", {"ROBOT/arm class=newest rate=20 layout=n:i32,f64[n]"});
  tunnel.run(Duration::s(2), [&] { send(a, "ROBOT/arm", arm(1)); });
  tunnel.run(Duration::ms(50));
  EXPECT_LE(b.channels.size(), 46u);
  EXPECT_GT(b.link->counters().channels_limited, 300u);
}

// Nobody knows which messages the others can do without: all come, or none.
TEST_F(Channels, AreNotThinnedForWhoWantsFewPosesAndLeftOutForWhoWantsNone) {
  House& a = add_house("alice", {kArm, kDesk});
  House& all = add_house("bob", {kArm, kDesk});
  tunnel.link_options.interest.others = 64;
  House& few = add_house("carol", {kArm, kDesk});
  tunnel.link_options.interest.others = 0;
  House& none = add_house("dora", {kArm, kDesk});
  send(a, "LIGHT/desk", arm(1, 9));
  for (int i = 0; i < 60; ++i) {
    send(a, "ROBOT/arm", arm(2));
    tunnel.dance(a, guest("alice"));
    tunnel.run(Duration::ms(20));
  }
  EXPECT_EQ(heard(all, "ROBOT/arm"), 60u);
  EXPECT_EQ(heard(few, "ROBOT/arm"), 60u);
  EXPECT_LT(few.heard_of(guest("alice")), 10u);
  EXPECT_EQ(heard(none, "ROBOT/arm"), 0u);
  EXPECT_EQ(last(none, "LIGHT/desk"), arm(1, 9)) << "a state: not of the dance";
}

// Who does not keep to its rules: the server stops what is too much, and poses go on.
TEST_F(Channels, AFloodPastTheLinkIsStoppedAtTheServerAndPosesPass) {
  House& a = add_house("alice", {});
  House& b = add_house("bob", {"ROBOT/arm class=newest rate=240 layout=n:i32,f64[n]"});
  const auto slot = tunnel.server().sessions()[0].slots[0];
  const Bytes payload(500, 1);
  std::uint32_t sequence = 0;
  const std::size_t before = b.heard_of(guest("alice"));
  tunnel.run(Duration::s(2), [&] {
    std::array<std::uint8_t, wire::kMaxPlain> bytes;
    wire::RecordsHeader header;
    header.number = static_cast<std::uint16_t>(++sequence);
    header.has_records = true;
    ByteWriter out(bytes);
    wire::begin_records(header, out);
    wire::Record record;
    record.kind = wire::RecordKind::kChannel;
    record.slot = slot;
    record.sequence = sequence;
    record.payload = payload;
    wire::RecordChain chain;
    wire::add_record(record, false, chain, out);
    tunnel.inject(a.peer, out.written());
    if (tunnel.now().since_zero_us() / 1000 % 16 == 0) tunnel.dance(a, guest("alice"));
  });
  EXPECT_GT(tunnel.server().counters().of(ServerReject::kChannelRate), 1000u);
  EXPECT_GE(b.heard_of(guest("alice")) - before, 122u);
  EXPECT_TRUE(b.channels.empty());
  EXPECT_GT(b.link->counters().channels_unrouted, 100u) << "never announced";
}

// The same dance with and without a channel beside it: each pose comes at the same time.
TEST(ChannelsBeside, PosesComeAsWithoutThem) {
  const auto dance_beside = [](bool is_busy) {
    SimulatedTunnel tunnel;
    tunnel.link_options.channels = {
        *ChannelRule::parse("ROBOT/* class=newest rate=240 layout=n:i32,f64[n]")};
    House& a = tunnel.add_house("salsa", {"alice"});
    House& b = tunnel.add_house("salsa", {"bob"});
    tunnel.run(Duration::ms(500));
    tunnel.run(Duration::s(2), [&] {
      const std::int64_t ms = tunnel.now().since_zero_us() / 1000;
      if (is_busy && ms % 5 == 0)
        for (const char* name : {"ROBOT/a", "ROBOT/b", "ROBOT/c"})
          a.link->send_channel(name, arm(20), tunnel.time_in(a));
      if (ms % 16 == 0) tunnel.dance(a, guest("alice"));
    });
    EXPECT_EQ(b.channels.empty(), !is_busy);
    std::vector<std::pair<std::uint32_t, MonoTime>> heard;
    for (const auto& pose : b.poses) heard.emplace_back(pose.pose.sequence, pose.at);
    return heard;
  };
  const auto quiet = dance_beside(false);
  EXPECT_GT(quiet.size(), 120u);
  EXPECT_EQ(dance_beside(true), quiet);
}

TEST_F(Channels, GoOnAfterAServersRestart) {
  House& a = add_house("alice", {kArm, kDesk});
  House& b = add_house("bob", {kArm, kDesk});
  send(a, "LIGHT/desk", arm(1, 1));
  send(a, "ROBOT/arm", arm(1, 1));
  tunnel.run(Duration::ms(100));
  tunnel.stop_server();
  tunnel.run(Duration::s(1));
  tunnel.start_server();
  tunnel.run(Duration::s(2));
  b.channels.clear();
  tunnel.run(Duration::s(1), [&] {
    if (tunnel.now().since_zero_us() / 1000 % 20 == 0) send(a, "ROBOT/arm", arm(1, 2));
  });
  EXPECT_GE(heard(b, "ROBOT/arm"), 45u);
  House& c = add_house("carol", {kDesk});
  EXPECT_EQ(last(c, "LIGHT/desk"), arm(1, 1));
}

}  // namespace
}  // namespace dance

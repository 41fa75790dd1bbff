// A host removes a guest from the room: link, server and link again.
#include <gtest/gtest.h>

#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

constexpr const char* kRefusedAsRemoved = "refused 11 ";
const Access kHostKey{.name = GuestId(), .role = Role::kHost, .any_name = true};

Access own_key(const char* name, Role role = Role::kGuest) {
  return {.name = guest(name), .role = role};
}

struct Room {
  Room() {
    host = &add("hanna", own_key("hanna", Role::kHost));
    bob = &add("bob", own_key("bob"));
    carla = &add("carla", own_key("carla"));
    tunnel.run(Duration::ms(600));
  }
  House& add(const std::string& name, const Access& access) {
    return tunnel.add_house("salsa", {name}, Duration::s(static_cast<std::int64_t>(name.size())),
                            access);
  }
  bool is_here(const char* name) const {
    for (const ServerSession& session : tunnel_server().sessions())
      for (const std::uint8_t slot : session.slots)
        if (session.in_use && tunnel_server().rooms()[session.room].guests[slot].id == guest(name))
          return true;
    return false;
  }
  const ServerCore& tunnel_server() const { return const_cast<SimulatedTunnel&>(tunnel).server(); }
  std::size_t hellos_of_bob(Duration duration) {
    const std::uint64_t before = bob->link->counters().hellos;
    tunnel.run(duration);
    return bob->link->counters().hellos - before;
  }

  SimulatedTunnel tunnel;
  House* host = nullptr;
  House* bob = nullptr;
  House* carla = nullptr;
};

TEST(Removal, EndsTheGuestsSessionAtOnceAndTellsTheReason) {
  Room room;
  ASSERT_TRUE(room.is_here("bob"));
  EXPECT_TRUE(room.host->link->may_remove());
  EXPECT_FALSE(room.carla->link->may_remove());
  room.host->link->ask_removal(guest("bob"), 1);
  room.tunnel.run(Duration::ms(50));
  EXPECT_FALSE(room.is_here("bob"));
  EXPECT_TRUE(room.bob->saw(kRefusedAsRemoved));
  EXPECT_FALSE(room.bob->saw("lapsed")) << "it does not look for its server, nor for another";
  EXPECT_TRUE(room.carla->saw("-bob"));
  EXPECT_TRUE(room.host->saw("-bob"));
  EXPECT_TRUE(room.is_here("carla"));
  EXPECT_EQ(room.tunnel_server().counters().sessions_removed, 1u);
}

TEST(Removal, ItsHouseAsksForNothingUntilTheTimeIsOver) {
  Room room;
  room.host->link->ask_removal(guest("bob"), 1);
  room.tunnel.run(Duration::ms(50));
  EXPECT_EQ(room.hellos_of_bob(Duration::s(30)), 0u);
  // A pose of a new guest of the house is no reason either, nor a new sealed session.
  room.tunnel.dance(*room.bob, guest("bob-2"));
  room.tunnel.seal_anew(*room.bob);
  EXPECT_EQ(room.hellos_of_bob(Duration::s(10)), 0u);
  room.tunnel.run(wire::kRemovedFor);
  EXPECT_TRUE(room.is_here("bob")) << "then it comes back by itself";
}

TEST(Removal, TheServerRefusesANewLinkOfTheSameKeyAndSaysForHowLong) {
  Room room;
  std::vector<std::uint16_t> seconds;
  room.tunnel.on_datagram = [&](bool to_server, PeerId, wire::Bytes bytes) {
    const auto opening = wire::parse_opening(bytes);
    if (to_server || opening->type != wire::Type::kRefusal) return true;
    if (const auto refusal = wire::parse_refusal(opening->body))
      seconds.push_back(refusal->seconds);
    return true;
  };
  room.host->link->ask_removal(guest("bob"), 1);
  room.tunnel.run(Duration::s(60));
  room.tunnel.start_link(*room.bob, "salsa", {"bob-again"});
  room.tunnel.run(Duration::s(2));
  EXPECT_FALSE(room.is_here("bob-again"));
  ASSERT_EQ(seconds.size(), 2u);
  EXPECT_EQ(seconds[0], 600);
  EXPECT_NEAR(seconds[1], 540, 1);
  room.tunnel.start_link(*room.bob, "tango", {"bob"});
  room.tunnel.run(Duration::s(1));
  EXPECT_TRUE(room.is_here("bob")) << "it is a room's matter";
}

TEST(Removal, AGuestMayNotAndIsCounted) {
  Room room;
  const std::uint64_t before = room.tunnel_server().counters().of(ServerReject::kNotAllowed);
  std::vector<wire::RemovalResult> answers;
  room.tunnel.on_datagram = [&](bool, PeerId, wire::Bytes bytes) {
    const auto opening = wire::parse_opening(bytes);
    if (opening->type == wire::Type::kRemovalAnswer)
      answers.push_back(wire::parse_removal_answer(opening->body)->result);
    return true;
  };
  room.carla->link->ask_removal(guest("bob"), 5);
  room.tunnel.run(Duration::s(1));
  EXPECT_TRUE(room.is_here("bob"));
  EXPECT_EQ(answers, std::vector{wire::RemovalResult::kNotAllowed});
  EXPECT_EQ(room.tunnel_server().counters().of(ServerReject::kNotAllowed), before + 1);
  answers.clear();
  room.host->link->ask_removal(guest("nobody"), 6);
  room.host->link->ask_removal(guest("hanna"), 7);  // own: the server is not asked
  room.tunnel.run(Duration::s(1));
  EXPECT_EQ(answers, std::vector{wire::RemovalResult::kNoSuchGuest});
  EXPECT_TRUE(room.is_here("hanna"));
}

TEST(Removal, IsAskedAgainWhereItIsLostAndDoneOnce) {
  Room room;
  int requests = 0, answers = 0;
  room.tunnel.on_datagram = [&](bool to_server, PeerId, wire::Bytes bytes) {
    const auto type = wire::parse_opening(bytes)->type;
    if (to_server && type == wire::Type::kRemoval) return ++requests > 2;
    if (!to_server && type == wire::Type::kRemovalAnswer) return ++answers > 1;
    return true;
  };
  room.host->link->ask_removal(guest("bob"), 1);
  room.host->link->ask_removal(guest("bob"), 1);  // the panel says it again: the same wish
  room.tunnel.run(Duration::s(2));
  EXPECT_FALSE(room.is_here("bob"));
  EXPECT_EQ(requests, 4) << "two were lost, and one answer";
  EXPECT_EQ(answers, 2);
  EXPECT_EQ(room.tunnel_server().counters().sessions_removed, 1u);
}

TEST(Removal, HoldsThoughTheNoticeIsLost) {
  Room room;
  room.tunnel.on_datagram = [lost = false](bool to_server, PeerId, wire::Bytes bytes) mutable {
    const bool is_notice = !to_server && wire::parse_opening(bytes)->type == wire::Type::kRefusal;
    if (is_notice && !lost) {
      lost = true;
      return false;
    }
    return true;
  };
  room.host->link->ask_removal(guest("bob"), 1);
  room.tunnel.run(Duration::s(2));
  EXPECT_TRUE(room.bob->saw(kRefusedAsRemoved)) << "its ping was answered, and its hello refused";
  EXPECT_FALSE(room.is_here("bob"));
  EXPECT_EQ(room.hellos_of_bob(Duration::s(10)), 0u);
}

TEST(Removal, OfAKeyThatAllShareRefusesTheNamesOfThatLink) {
  SimulatedTunnel tunnel;
  House& host = tunnel.add_house("salsa", {"hanna"}, {}, kHostKey);
  House& pair = tunnel.add_house("salsa", {"bob", "bea"});
  House& other = tunnel.add_house("salsa", {"carla"});
  tunnel.run(Duration::ms(300));
  host.link->ask_removal(guest("bea"), 1);
  tunnel.run(Duration::ms(100));
  EXPECT_TRUE(pair.saw(kRefusedAsRemoved));
  EXPECT_TRUE(other.saw("-bob")) << "one house: both of its guests leave";
  EXPECT_FALSE(other.saw("-carla"));
  tunnel.start_link(pair, "salsa", {"bob"});
  tunnel.run(Duration::s(1));
  EXPECT_FALSE(pair.link->is_connected());
  EXPECT_TRUE(other.link->is_connected());
}

TEST(Removal, OfManyAtOnceIsBounded) {
  SimulatedTunnel tunnel;
  House& host = tunnel.add_house("salsa", {"hanna"}, {}, kHostKey);
  for (int i = 0; i < 20; ++i)
    tunnel.add_house("salsa", {"g" + std::to_string(i)}, {},
                     own_key(("g" + std::to_string(i)).c_str()));
  tunnel.run(Duration::ms(600));
  std::map<wire::RemovalResult, int> answers;
  tunnel.on_datagram = [&](bool, PeerId, wire::Bytes bytes) {
    const auto opening = wire::parse_opening(bytes);
    if (opening->type == wire::Type::kRemovalAnswer)
      ++answers[wire::parse_removal_answer(opening->body)->result];
    return true;
  };
  for (int i = 0; i < 20; ++i) {
    host.link->ask_removal(guest("g" + std::to_string(i)), i + 1);
    tunnel.run(Duration::ms(20));
  }
  EXPECT_EQ(answers[wire::RemovalResult::kDone], 16);
  EXPECT_GE(answers[wire::RemovalResult::kTooMany], 4) << "one may be asked twice";
}

// A server of before drops the type that it does not know.
TEST(Removal, SaysSoWhereTheServerDoesNotAnswer) {
  Room room;
  room.tunnel.on_datagram = [](bool to_server, PeerId, wire::Bytes bytes) {
    return !to_server || wire::parse_opening(bytes)->type != wire::Type::kRemoval;
  };
  room.host->link->ask_removal(guest("bob"), 1);
  room.tunnel.run(Duration::s(10));
  EXPECT_TRUE(room.is_here("bob"));
  EXPECT_TRUE(room.host->saw("removal 1 6"));
  EXPECT_TRUE(room.host->link->is_connected());
}

TEST(Removal, NeedsTheSealedSessionToTellALinkThatItWasRemoved) {
  Room room;
  wire::RefusalNotice notice;
  notice.cause = wire::Refusal::kRemoved;
  notice.nonce = 12345;  // not of its hello, nor unasked
  notice.seconds = 600;
  std::array<std::uint8_t, 64> out;
  const std::size_t size = wire::build(notice, out);
  room.bob->link->receive({out.data(), size}, room.tunnel.time_in(*room.bob),
                          room.tunnel.time_in(*room.bob));
  EXPECT_TRUE(room.bob->link->is_connected());
}

}  // namespace
}  // namespace dance

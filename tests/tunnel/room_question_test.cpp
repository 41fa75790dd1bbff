// Who is in a room, asked without coming in: byte by byte, and what a server answers.
#include <gtest/gtest.h>

#include <vector>

#include "tests/tunnel/simulated_tunnel.h"
#include "tunnel/wire/wire_room.h"

namespace dance {
namespace {

using wire::RoomResult;
using Datagram = std::vector<std::uint8_t>;

template <class Message>
Datagram written_of_room(const Message& message) {
  std::array<std::uint8_t, wire::kMaxPlain> out;
  return {out.begin(), out.begin() + static_cast<std::ptrdiff_t>(wire::build(message, out))};
}

template <class Parse>
void expect_room_damage_is_refused(const Datagram& datagram, Parse parse) {
  for (std::size_t size = 1; size < datagram.size(); ++size)
    EXPECT_FALSE(parse(wire::Bytes(datagram).subspan(1, size - 1))) << "cut to " << size;
  Datagram longer = datagram;
  longer.push_back(0);
  EXPECT_FALSE(parse(wire::Bytes(longer).subspan(1)));
  Datagram other_form = datagram;
  other_form[1] = wire::kRoomForm + 1;
  EXPECT_FALSE(parse(wire::Bytes(other_form).subspan(1)));
}

TEST(RoomWire, IsAsDocumented) {
  const Datagram question = written_of_room(wire::RoomQuestion{0x01020304, guest("salsa")});
  EXPECT_EQ(question, (Datagram{34, 1, 4, 3, 2, 1, 5, 's', 'a', 'l', 's', 'a'}));
  const auto asked = wire::parse_room_question(wire::Bytes(question).subspan(1));
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->number, 0x01020304u);
  EXPECT_EQ(asked->room.view(), "salsa");
  wire::RoomAnswer answer{7, RoomResult::kKnown, 3, {}};
  ASSERT_TRUE(answer.names.try_push(guest("ann")) && answer.names.try_push(guest("bo")));
  const Datagram told = written_of_room(answer);
  EXPECT_EQ(told, (Datagram{35, 1, 7, 0, 0, 0, 1, 3, 2, 3, 'a', 'n', 'n', 2, 'b', 'o'}));
  const auto read = wire::parse_room_answer(wire::Bytes(told).subspan(1));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->number, 7u);
  EXPECT_EQ(read->count, 3);
  ASSERT_EQ(read->names.size(), 2u);
  EXPECT_EQ(read->names[1].view(), "bo");
}

TEST(RoomWire, RefusesWhatIsNeverWritten) {
  expect_room_damage_is_refused(written_of_room(wire::RoomQuestion{7, guest("salsa")}),
                                wire::parse_room_question);
  wire::RoomAnswer answer{7, RoomResult::kKnown, 1, {}};
  ASSERT_TRUE(answer.names.try_push(guest("ann")));
  expect_room_damage_is_refused(written_of_room(answer), wire::parse_room_answer);
  const auto refuses = [](auto parse, Datagram body) { EXPECT_FALSE(parse(wire::Bytes(body))); };
  refuses(wire::parse_room_question, {1, 0, 0, 0, 0, 1, 'a'});
  refuses(wire::parse_room_question, {1, 7, 0, 0, 0, 1, 27});
  refuses(wire::parse_room_question, {1, 7, 0, 0, 0, 0});
  refuses(wire::parse_room_answer, {1, 0, 0, 0, 0, 1, 0, 0});
  refuses(wire::parse_room_answer, {1, 7, 0, 0, 0, 0, 0, 0});
  refuses(wire::parse_room_answer, {1, 7, 0, 0, 0, 4, 0, 0});
  refuses(wire::parse_room_answer, {1, 7, 0, 0, 0, 1, 0, 1, 1, 'a'});  // more than there are
  refuses(wire::parse_room_answer, {1, 7, 0, 0, 0, 1, 129, 0});        // than fit
  refuses(wire::parse_room_answer, {1, 7, 0, 0, 0, 1, 2, 2, 1, 'a', 1, 'a'});  // one twice
  refuses(wire::parse_room_answer, {1, 7, 0, 0, 0, 2, 1, 0});                  // told after all
}

class RoomQuestions : public ::testing::Test {
 protected:
  RoomQuestions() {
    tunnel.on_datagram = [this](bool to_server, PeerId peer, wire::Bytes bytes) {
      const auto opening = wire::parse_opening(bytes);
      if (!to_server && opening && opening->type == wire::Type::kRoomAnswer) {
        answers.push_back(*wire::parse_room_answer(opening->body));
        answered = peer;
      }
      return true;
    };
  }
  wire::RoomAnswer ask(PeerId from, const char* room) {
    const std::size_t before = answers.size();
    tunnel.inject(from, written_of_room(wire::RoomQuestion{++number, guest(room)}));
    EXPECT_EQ(answers.size(), before + 1);
    EXPECT_EQ(answered, from);
    EXPECT_EQ(answers.back().number, number);
    return answers.back();
  }
  static std::string names_of(const wire::RoomAnswer& answer) {
    std::string names;
    for (const GuestId& name : answer.names) names += std::string(name.view()) + " ";
    return names;
  }

  SimulatedTunnel tunnel;
  std::vector<wire::RoomAnswer> answers;
  PeerId answered = 0;
  std::uint32_t number = 0;
};

TEST_F(RoomQuestions, AreAnsweredToWhoHoldsAKeyAndNobodyComesIn) {
  auto& a = tunnel.add_house("salsa", {"alice", "anna"});
  tunnel.add_house("salsa", {"bob"});
  tunnel.add_house("tango", {"carol"});
  tunnel.run(Duration::ms(200));
  const PeerId asking = tunnel.add_peer({.name = guest("dora"), .room = guest("salsa")});
  const wire::RoomAnswer salsa = ask(asking, "salsa");
  EXPECT_EQ(salsa.result, RoomResult::kKnown);
  EXPECT_EQ(salsa.count, 3);
  EXPECT_EQ(names_of(salsa), "alice anna bob ");
  const wire::RoomAnswer tango = ask(asking, "tango");
  EXPECT_EQ(tango.result, RoomResult::kNotAllowed);
  EXPECT_EQ(tango.count, 0) << "the key opens one room";
  EXPECT_EQ(tunnel.server().counters().of(ServerReject::kNotAllowed), 1u);
  EXPECT_EQ(tunnel.server().session_count(), 3u);
  EXPECT_EQ(tunnel.server().room_count(), 2u);
  tunnel.run(Duration::ms(500));
  for (const std::string& event : a.events) EXPECT_NE(event, "+dora");
  EXPECT_EQ(names_of(ask(a.peer, "salsa")), "alice anna bob ") << "one who is in may ask, too";
}

TEST_F(RoomQuestions, OpenNoRoomAndNameNoMoreThanFits) {
  const PeerId asking = tunnel.add_peer();
  EXPECT_EQ(ask(asking, "nowhere").result, RoomResult::kKnown);
  EXPECT_EQ(answers.back().count, 0);
  EXPECT_EQ(tunnel.server().room_count(), 0u);
  for (int house = 0; house < 4; ++house) {
    std::vector<std::string> names;
    for (int i = 0; i < 12; ++i)
      names.push_back("g" + std::to_string(house) + "-with-a-long-name-" + std::to_string(i));
    // Two keys, as one key fills half of a room at most.
    const Access access{.name = guest(house < 2 ? "first" : "second"), .any_name = true};
    tunnel.add_house("salsa", names, {}, access);
  }
  tunnel.run(Duration::ms(300));
  const wire::RoomAnswer crowd = ask(asking, "salsa");
  EXPECT_EQ(crowd.count, 48);
  EXPECT_EQ(crowd.names.size(), wire::kMostNamesTold);
}

TEST_F(RoomQuestions, OfAGuestWhomAHostHasRemovedAreRefused) {
  auto& bob = tunnel.add_house("salsa", {"bob"}, {}, {.name = guest("bob")});
  auto& host =
      tunnel.add_house("salsa", {"hanna"}, {}, {.name = guest("hanna"), .role = Role::kHost});
  tunnel.run(Duration::ms(200));
  host.link->ask_removal(guest("bob"), 5);
  tunnel.run(Duration::ms(200));
  EXPECT_EQ(ask(bob.peer, "salsa").result, RoomResult::kNotAllowed);
  EXPECT_EQ(ask(tunnel.add_peer({.name = guest("dora")}), "salsa").result, RoomResult::kKnown);
}

TEST_F(RoomQuestions, WithOneKeyAreNotAnsweredWithoutEnd) {
  const PeerId asking = tunnel.add_peer({.name = guest("dora")});
  const Datagram question = written_of_room(wire::RoomQuestion{1, guest("salsa")});
  for (int i = 0; i < 500; ++i) tunnel.inject(asking, question);
  EXPECT_GT(answers.size(), 31u) << "all rooms of a window at once";
  EXPECT_LT(answers.size(), 100u);
  EXPECT_GT(tunnel.server().counters().of(ServerReject::kSessionRate), 400u);
  tunnel.inject(tunnel.add_peer({.name = guest("emil")}), question);
  EXPECT_EQ(answered, asking + 1) << "that key alone";
  tunnel.inject(tunnel.add_peer({.name = guest("fred")}), Datagram{34, 1, 0, 0});
  EXPECT_EQ(tunnel.server().counters().of(ServerReject::kMalformed), 1u);
}

}  // namespace
}  // namespace dance

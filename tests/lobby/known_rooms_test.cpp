// What the window knows of the rooms in its list: from a server that runs, the way there, and who
// is in them, with a key; and what becomes of answers.
#include "lobby/run/known_rooms.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/net/mono_clock.h"
#include "tests/test_folder.h"
#include "tests/tunnel/seal/guest_key.h"
#include "tunnel/link/link.h"
#include "tunnel/seal/keys/house_keys.h"
#include "tunnel/seal/keys/key_files.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

TEST(KnownRooms, AreAskedWhoIsThereWithTheKeyOfTheHouse) {
  const TestFolder folder("known-rooms");
  auto poller = *Poller::create();
  GuestKey key = key_of("bob");
  key.room = *GuestId::parse("salsa");
  KeyRing ring;
  ASSERT_TRUE(ring.add(key));
  ServerOptions options;
  options.keys = std::make_shared<const KeyRing>(std::move(ring));
  auto server = Server::open(Address::loopback(0), options, *poller);
  ASSERT_TRUE(server) << server.error().what;
  LinkOptions of;
  of.room = *GuestId::parse("salsa");
  ASSERT_TRUE(of.guests.try_push(key.name));
  const PublicKey server_key = options.identity.public_key();
  auto link =
      Link::open({(*server)->local_address()}, link_key_of(key, server_key), of, {}, *poller);
  ASSERT_TRUE(link);

  const std::string address = (*server)->local_address().to_string();
  HouseKeys keys;
  keys.put({key.name, address, GuestId(), server_key, key.own});
  ASSERT_TRUE(write_secret(folder.path("keys"), keys.text()));
  std::ofstream(folder.path("house.toml"))
      << "[house]\nguest = \"bob\"\nkey_file = \"" << folder.path("keys") << "\"\n";
  LobbyModel model;
  model.settings.name = "bob";
  model.settings.window.rooms = {{"salsa", address}, {"tango", address}};
  std::atomic<int> told{0};
  KnownRooms rooms(folder.path("house.toml"), [&] { ++told; });
  const auto turn_until = [&](const auto& is_so) {
    const MonoTime given_up = mono_now() + Duration::s(30);
    while (!is_so() && mono_now() < given_up) poller->run_once(Duration::ms(5));
    return is_so();
  };
  ASSERT_TRUE(turn_until([&] { return (*link)->is_connected(); }));
  const auto know_both = [&] {
    // As where answers take longer than it takes until they are asked for again.
    rooms.look(model, mono_now() + KnownRooms::kAgain + Duration::s(1));
    return model.rooms[0].who == RoomFact::Who::kKnown &&
           model.rooms[1].who != RoomFact::Who::kUnknown;
  };
  rooms.ask(model);
  EXPECT_TRUE(turn_until(know_both));
  EXPECT_EQ(model.rooms[0].state, RoomFact::State::kAnswers);
  EXPECT_EQ(model.rooms[0].guest_count, 1u);
  EXPECT_EQ(model.rooms[0].guests, std::vector<std::string>{"bob"});
  EXPECT_EQ(model.rooms[1].who, RoomFact::Who::kRefused) << "the key opens one room";
  EXPECT_GE(told.load(), 1);
  EXPECT_EQ((*server)->core().session_count(), 1u);
  EXPECT_EQ((*server)->core().room_count(), 1u);

  // One key for one of them.
  keys = HouseKeys();
  keys.put({key.name, address, key.room, server_key, key.own});
  ASSERT_TRUE(write_secret(folder.path("keys"), keys.text()));
  rooms.ask(model);
  EXPECT_TRUE(turn_until(know_both));
  EXPECT_EQ(model.rooms[1].who, RoomFact::Who::kNoKey);
  const auto find = [&] {
    return find_link_key(address, (*server)->local_address(), *GuestId::parse("tango"), key.name,
                         {folder.path("keys"), {}});
  };
  const auto none = find();
  EXPECT_TRUE(none && !*none);
  ASSERT_TRUE(write_secret(folder.path("keys"), "this is no key\n"));
  EXPECT_FALSE(find()) << "there may be one in it";
}

using Server = RoundTrips::Answer::Server;

RoundTrips::Answer answer_of(const char* room, RoomGuests::State state, const char* guest = "") {
  RoundTrips::Answer answer{{room, "a.org"}, Server::kAnswers, Duration::ms(9), {}, mono_now()};
  answer.guests.state = state;
  if (state != RoomGuests::State::kKnown) return answer;
  answer.guests.count = 1;
  EXPECT_TRUE(answer.guests.names.try_push(*GuestId::parse(guest)));
  return answer;
}

struct KnownRoomFacts : testing::Test {
  KnownRoomFacts() {
    model.settings.window.rooms = {{"salsa", "a.org"}, {"tango", "a.org"}};
    model.rooms.resize(2);
    KnownRooms::take(model, {1,
                             {answer_of("salsa", RoomGuests::State::kKnown, "bob"),
                              answer_of("tango", RoomGuests::State::kKnown, "dora")}});
  }
  std::string names() const {
    std::string all;
    for (const RoomFact& room : model.rooms)
      all += (room.guests.empty() ? "-" : room.guests[0]) + " ";
    return all;
  }
  LobbyModel model;
};

TEST_F(KnownRoomFacts, AreOfTheRoomThatWasAskedForWhereverItIsByNow) {
  EXPECT_EQ(names(), "bob dora ");
  model.choose_room({"tango", "a.org"});
  model.remember_room();
  EXPECT_EQ(names(), "dora bob ");
  model.forget_room(1);
  KnownRooms::take(model, {1,
                           {answer_of("salsa", RoomGuests::State::kKnown, "ann"),
                            answer_of("tango", RoomGuests::State::kKnown, "emil")}});
  EXPECT_EQ(names(), "emil ");
}

TEST_F(KnownRoomFacts, OfGuestsWhoMayHaveGoneAreForgotten) {
  KnownRooms::take(model, {2,
                           {answer_of("salsa", RoomGuests::State::kNotHere),
                            answer_of("tango", RoomGuests::State::kUnanswered)}});
  EXPECT_EQ(names(), "- dora ") << "a question that is lost says nothing";
  EXPECT_EQ(model.rooms[0].who, RoomFact::Who::kUnknown);
  EXPECT_FALSE(KnownRooms::forget_old_names(model, mono_now()));
  EXPECT_TRUE(KnownRooms::forget_old_names(model, mono_now() + KnownRooms::kNamesHold));
  EXPECT_EQ(names(), "- - ");
  EXPECT_EQ(model.rooms[1].who, RoomFact::Who::kUnknown);
}

TEST_F(KnownRoomFacts, ThatAreNotThereYetChangeNothing) {
  RoundTrips::Answer silent{{"tango", "a.org"}, Server::kSilent, {}, {}, {}};
  KnownRooms::take(model, {2, {{{"salsa", "a.org"}, Server::kAsking, {}, {}, {}}, silent}});
  EXPECT_EQ(names(), "bob - ");
  EXPECT_EQ(model.rooms[0].state, RoomFact::State::kAnswers);
  EXPECT_EQ(model.rooms[1].state, RoomFact::State::kSilent);
}

}  // namespace
}  // namespace dance

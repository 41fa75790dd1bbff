// What the window knows of a room in its list, from a server that runs: the way there, and who is
// in it, with a key; and of one that it has no key for, that it has none.
#include "lobby/run/known_rooms.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/net/mono_clock.h"
#include "tests/test_folder.h"
#include "tunnel/link/link.h"
#include "tunnel/seal/house_keys.h"
#include "tunnel/seal/key_files.h"
#include "tunnel/server/server.h"

namespace dance {
namespace {

TEST(KnownRooms, AreAskedWhoIsThereWithTheKeyOfTheHouse) {
  const TestFolder folder("known-rooms");
  auto poller = *Poller::create();
  KeyEntry key;
  key.name = *GuestId::parse("bob");
  key.key = PresharedKey::make();
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
  LinkKey link_key;
  link_key.name = "bob";
  link_key.key = key.key;
  auto link = Link::open({(*server)->local_address()}, link_key, of, {}, *poller);
  ASSERT_TRUE(link);

  const std::string address = (*server)->local_address().to_string();
  HouseKeys keys;
  keys.put({*GuestId::parse("bob"), address, GuestId(), key.key});
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
  rooms.ask(model);
  EXPECT_TRUE(turn_until([&] {
    rooms.look(model, mono_now());
    return model.rooms[0].who == RoomFact::Who::kKnown &&
           model.rooms[1].who != RoomFact::Who::kUnknown;
  }));
  EXPECT_EQ(model.rooms[0].state, RoomFact::State::kAnswers);
  EXPECT_EQ(model.rooms[0].guest_count, 1u);
  EXPECT_EQ(model.rooms[0].guests, std::vector<std::string>{"bob"});
  EXPECT_EQ(model.rooms[1].who, RoomFact::Who::kNoKey) << "the key opens one room";
  EXPECT_GE(told.load(), 1);
  EXPECT_EQ((*server)->core().session_count(), 1u);
  EXPECT_EQ((*server)->core().room_count(), 1u);
}

}  // namespace
}  // namespace dance

// Tests the share of a server that the holder of one key may use.
#include "tunnel/server/core/key_quota.h"

#include <gtest/gtest.h>

#include "tests/tunnel/files/test_file.h"
#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

Access key_named(const std::string& name) { return {.name = guest(name)}; }

std::size_t connected(const std::vector<House*>& houses) {
  return static_cast<std::size_t>(std::ranges::count_if(
      houses, [](const House* house) { return house->link->is_connected(); }));
}

// An attack: one guest's key opened 256 sessions and took every place.
TEST(KeyQuota, OneKeyCannotTakeEverySession) {
  SimulatedTunnel tunnel;
  std::vector<House*> of_mallory;
  for (int i = 0; i < 40; ++i)
    of_mallory.push_back(&tunnel.add_house("salsa", {}, {}, key_named("mallory")));
  tunnel.run(Duration::ms(500));
  EXPECT_EQ(connected(of_mallory), ServerLimits().sessions_per_key);
  EXPECT_TRUE(of_mallory.back()->saw("refused 12 "));
  auto& alice = tunnel.add_house("salsa", {"alice"}, {}, key_named("alice"));
  tunnel.run(Duration::ms(200));
  EXPECT_TRUE(alice.link->is_connected());
  // A session that ends makes room for another of the same key.
  of_mallory[0]->link->send_goodbye();
  of_mallory[0]->is_running = false;
  tunnel.run(Duration::s(2));
  EXPECT_EQ(connected({of_mallory.begin() + 1, of_mallory.end()}), ServerLimits().sessions_per_key);
}

TEST(KeyQuota, AReturningLinkKeepsItsSessionWhenItsKeyIsAtTheLimit) {
  SimulatedTunnel tunnel({.sessions_per_key = 1});
  auto& alice = tunnel.add_house("salsa", {"alice"}, {}, key_named("alice"));
  tunnel.run(Duration::ms(200));
  ASSERT_TRUE(alice.link->is_connected());
  tunnel.seal_anew(alice);
  tunnel.run(Duration::ms(200));
  EXPECT_TRUE(alice.link->is_connected());
  EXPECT_EQ(tunnel.server().counters().sessions_resumed, 1u);
}

TEST(KeyQuota, OneKeyCannotOpenEveryRoom) {
  SimulatedTunnel tunnel({.sessions_per_key = 100});
  std::vector<House*> of_mallory;
  for (int i = 0; i < 64; ++i)
    of_mallory.push_back(&tunnel.add_house("m" + std::to_string(i), {}, {}, key_named("mallory")));
  tunnel.run(Duration::s(3));
  EXPECT_EQ(tunnel.server().room_count(), ServerLimits().rooms_per_key);
  EXPECT_TRUE(of_mallory.back()->saw("refused 13 "));
  auto& alice = tunnel.add_house("salsa", {"alice"}, {}, key_named("alice"));
  tunnel.run(Duration::ms(200));
  EXPECT_TRUE(alice.link->is_connected());
  // Rooms that others opened do not count.
  auto& guest_of_alice = tunnel.add_house("salsa", {}, {}, key_named("mallory"));
  tunnel.run(Duration::ms(200));
  EXPECT_TRUE(guest_of_alice.link->is_connected());
}

TEST(KeyQuota, AKeyThatARoomSharesLeavesHalfToOthers) {
  SimulatedTunnel tunnel({.sessions = 40, .listeners_per_room = 64});
  Access room_key = key_named("party");
  room_key.any_name = true;
  std::vector<House*> party;
  for (int i = 0; i < 40; ++i) party.push_back(&tunnel.add_house("salsa", {}, {}, room_key));
  tunnel.run(Duration::s(1));
  EXPECT_EQ(connected(party), 20u);
  auto& alice = tunnel.add_house("salsa", {"alice"}, {}, key_named("alice"));
  tunnel.run(Duration::ms(200));
  EXPECT_TRUE(alice.link->is_connected());
}

std::vector<std::string> numbered(const std::string& name, int from, int count) {
  std::vector<std::string> names;
  for (int i = from; i < from + count; ++i) names.push_back(name + "-" + std::to_string(i));
  return names;
}

// An attack: four links of one key, with 16 guests each, took all 64 places of a room.
TEST(KeyQuota, GuestsOfOneKeyLeaveARoomsPlacesToOthers) {
  SimulatedTunnel tunnel;
  std::vector<House*> of_mallory;
  for (int i = 0; i < 8; ++i)
    of_mallory.push_back(
        &tunnel.add_house("salsa", numbered("mallory", 16 * i, 16), {}, key_named("mallory")));
  tunnel.run(Duration::ms(500));
  EXPECT_EQ(connected(of_mallory), 1u);
  EXPECT_TRUE(of_mallory.back()->saw("refused 15 "));
  EXPECT_EQ(tunnel.server().guest_count(), ServerLimits().guests_per_key);
  auto& alice = tunnel.add_house("salsa", {"alice"}, {}, key_named("alice"));
  tunnel.run(Duration::ms(200));
  EXPECT_TRUE(alice.link->is_connected());
  // The same names in another room are places of that room.
  auto& elsewhere = tunnel.add_house("tango", numbered("mallory", 0, 16), {}, key_named("mallory"));
  tunnel.run(Duration::ms(200));
  EXPECT_TRUE(elsewhere.link->is_connected());
}

TEST(KeyQuota, AReturningLinkKeepsItsGuestsWhenItsKeyIsAtTheLimit) {
  SimulatedTunnel tunnel;
  auto& alice = tunnel.add_house("salsa", numbered("alice", 0, 16), {}, key_named("alice"));
  tunnel.run(Duration::ms(200));
  tunnel.seal_anew(alice);
  tunnel.run(Duration::ms(200));
  EXPECT_TRUE(alice.link->is_connected());
  EXPECT_EQ(tunnel.server().counters().sessions_resumed, 1u);
  EXPECT_EQ(tunnel.server().guest_count(), 16u);
}

TEST(KeyQuota, GuestsOfARoomsKeyLeaveHalfOfTheRoomToOthers) {
  SimulatedTunnel tunnel;
  const Access room_key{.name = guest("party"), .any_name = true};
  std::vector<House*> party;
  for (int i = 0; i < 8; ++i)
    party.push_back(&tunnel.add_house("salsa", numbered("dancer", 8 * i, 8), {}, room_key));
  tunnel.run(Duration::ms(500));
  EXPECT_EQ(connected(party), 4u);
  EXPECT_TRUE(party.back()->saw("refused 15 "));
  auto& alice = tunnel.add_house("salsa", {"alice"}, {}, key_named("alice"));
  tunnel.run(Duration::ms(200));
  EXPECT_TRUE(alice.link->is_connected());
}

TEST(KeyQuota, ListenersOfARoomsKeyLeaveHalfOfTheirPlacesToOthers) {
  SimulatedTunnel tunnel;
  const Access room_key{.name = guest("party"), .any_name = true};
  std::vector<House*> party;
  for (int i = 0; i < 40; ++i) party.push_back(&tunnel.add_house("salsa", {}, {}, room_key));
  tunnel.run(Duration::s(1));
  EXPECT_EQ(connected(party), ServerLimits().listeners_per_room / 2);
  auto& alice = tunnel.add_house("salsa", {}, {}, key_named("alice"));
  tunnel.run(Duration::ms(200));
  EXPECT_TRUE(alice.link->is_connected());
}

TEST(KeyQuota, TheKeyOfTheServersMachineHasNoLimitOfItsOwn) {
  SimulatedTunnel tunnel({.sessions = 40, .listeners_per_room = 64});
  const Access local{.name = guest("local"), .any_name = true, .is_local = true};
  std::vector<House*> programs;
  for (int i = 0; i < 40; ++i) programs.push_back(&tunnel.add_house("salsa", {}, {}, local));
  tunnel.run(Duration::s(1));
  EXPECT_EQ(connected(programs), 40u);
}

TEST(KeyQuota, TrafficOfAllSessionsOfOneKeyIsLimitedTogether) {
  ServerLimits limits;
  limits.bytes_per_second = 10'000.0;
  limits.byte_burst = 5'000.0;
  SimulatedTunnel tunnel(limits);
  std::vector<House*> of_mallory;
  for (int i = 0; i < 8; ++i)
    of_mallory.push_back(&tunnel.add_house("salsa", {}, {}, key_named("mallory")));
  auto& alice = tunnel.add_house("salsa", {"alice"}, {}, key_named("alice"));
  tunnel.run(Duration::ms(500));
  ASSERT_EQ(connected(of_mallory), 8u);
  // Each session alone stays below its own limit: 8 × 8 kB a second.
  const std::vector<std::uint8_t> bytes(800, 200);
  const std::uint64_t before = tunnel.server().counters().of(ServerReject::kUnknownType);
  for (int i = 0; i < 100; ++i) {
    for (const House* house : of_mallory) tunnel.inject(house->peer, bytes);
    tunnel.run(Duration::ms(100));
  }
  const std::uint64_t passed = tunnel.server().counters().of(ServerReject::kUnknownType) - before;
  EXPECT_LT(static_cast<double>(passed) * 800.0, 10.0 * 2 * limits.bytes_per_second + 20'000.0);
  EXPECT_GT(tunnel.server().counters().of(ServerReject::kKeyRate), 100u);
  EXPECT_TRUE(alice.link->is_connected());
}

TEST(KeyQuota, AvatarsOfAllSessionsOfOneKeyShareItsMemory) {
  ServerLimits limits;
  limits.file_bytes_per_session = 100'000;
  limits.file_bytes = 350'000;
  SimulatedTunnel tunnel(limits);
  auto& bob = tunnel.add_house("salsa", {"bob"}, {}, key_named("bob"));
  std::vector<std::pair<std::string, House*>> owners;
  for (int i = 0; i < 4; ++i) {
    const std::string name = "mallory-" + std::to_string(i);
    owners.emplace_back(name, &tunnel.add_house("salsa", {name}, {}, key_named("mallory")));
  }
  tunnel.run(Duration::ms(500));
  std::uint8_t kind = 1;
  for (const auto& [name, house] : owners) {
    const TestFile file = test_file(90'000, kind);
    kind = static_cast<std::uint8_t>(kind + 2);
    choose(tunnel, *house, name.c_str(), file);
    tunnel.run(Duration::ms(200));
    fetch(tunnel, bob, name.c_str(), file);
    tunnel.run(Duration::s(1));
    EXPECT_LE(tunnel.server().files().bytes_of_key(guest("mallory")), 100'000u);
  }
  // Another key's file finds room.
  auto& alice = tunnel.add_house("salsa", {"alice"}, {}, key_named("alice"));
  tunnel.run(Duration::ms(500));
  const TestFile file = test_file(90'000, 99);
  choose(tunnel, alice, "alice", file);
  tunnel.run(Duration::ms(200));
  fetch(tunnel, bob, "alice", file);
  tunnel.run(Duration::s(2));
  EXPECT_EQ(bob.files[guest("alice")], file.bytes);
}

TEST(KeyUses, AReturningKeyHasTheTokensThatItLeft) {
  KeyUses uses(2);
  ServerLimits limits;
  limits.datagrams_per_second = 1.0;
  limits.datagram_burst = 5.0;  // twice that for the key of one person
  const MonoTime now = MonoTime::from_us(1'000'000);
  const std::size_t first = uses.join(key_named("mallory"), limits);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(uses.admits(first, 1, now));
  EXPECT_FALSE(uses.admits(first, 1, now));
  uses.leave(first);
  const std::size_t alice = uses.join(key_named("alice"), limits);
  EXPECT_TRUE(uses.admits(alice, 1, now));
  const std::size_t again = uses.join(key_named("mallory"), limits);
  EXPECT_EQ(uses.sessions_of(guest("mallory")), 1u);
  EXPECT_FALSE(uses.admits(again, 1, now));
}

}  // namespace
}  // namespace dance

// Servers that NATS joins, as they are run: poses pass, guests go to another server when theirs is
// killed, and what NATS servers do in between does not end the dance.
#include "tests/tunnel/cluster/nats_cluster.h"

#include <cstdlib>

namespace dance {
namespace {

TEST_F(NatsCluster, GuestsOfTwoServersDanceTogether) {
  start_nats(0, 1);
  for (const std::size_t server : {0u, 1u}) start_server(server);
  add_guest("alice", 0);
  add_guest("bob", 1);
  add_guest("carla", 1, "tango");
  ASSERT_TRUE(all_hear_all(100)) << talk();
  EXPECT_FALSE(guests[2]->heard.contains(guest("alice"))) << "another room";
  Voice voice;
  voice.clock_id = this_clock_id();
  ASSERT_TRUE(voice.set_packet(std::array<std::uint8_t, 40>{1}));
  EXPECT_TRUE(dance_until([&] {
    voice.capture_time = mono_now();
    ++voice.sequence;
    guests[0]->link->send(guest("alice"), voice, voice.capture_time);
    return guests[1]->voices[guest("alice")] >= 50;
  })) << talk();
  EXPECT_TRUE(guests[2]->voices.empty());
  for (const auto& one : guests) EXPECT_EQ(one->left, 0u);
}

TEST_F(NatsCluster, AServerThatIsAskedToEndHandsItsGuestsOn) {
  start_nats(0, 1);
  for (const std::size_t server : {0u, 1u, 2u}) start_server(server);
  add_guest("alice", 0);
  add_guest("bob", 1);
  add_guest("carla", 2);
  ASSERT_TRUE(all_hear_all(30)) << talk();
  servers_[0]->stop(Duration::s(10));
  servers_[0].reset();
  ASSERT_TRUE(all_hear_all(60)) << talk();
  EXPECT_NE(guests[0]->link->server(), address_of(0));
  for (const auto& one : guests) EXPECT_EQ(one->left, 0u) << one->id.view();
}

// SIGKILL of servers and of NATS nodes in turn, at random. DANCE_CLUSTER_KILLS says how often; it
// prints how long guests took to be back.
TEST_F(NatsCluster, AnyProgramMayBeKilled) {
  for (const std::size_t node : {0u, 1u, 2u}) start_nats(node, 3);
  for (const std::size_t server : {0u, 1u, 2u}) start_server(server);
  for (int i = 0; i < 6; ++i)
    add_guest("guest-" + std::to_string(i), static_cast<std::size_t>(i % 3));
  ASSERT_TRUE(all_hear_all(30, Duration::s(60))) << talk();

  const char* asked = std::getenv("DANCE_CLUSTER_KILLS");
  const int kills = asked != nullptr ? std::atoi(asked) : 4;
  Random random(2026);
  std::vector<double> back_s;
  int seemed_to_leave = 0;  // after so many kills somebody did, for a moment
  for (int kill = 0; kill < kills; ++kill) {
    const bool is_server = kill % 2 == 0;
    const std::size_t victim = random.next_u64() % 3;
    const std::uint64_t left_before = guests[0]->left;
    const bool has_guests = std::ranges::any_of(
        guests, [&](const auto& one) { return one->link->server() == address_of(victim); });
    const MonoTime begin = mono_now();
    kill_now(is_server ? servers_[victim] : nats_[victim]);
    if (is_server) {
      // Those who were there speak to another server.
      ASSERT_TRUE(dance_until([&] {
        return std::all_of(guests.begin(), guests.end(), [&](const auto& one) {
          return one->link->is_connected() && one->link->server() != address_of(victim);
        });
      })) << "kill "
          << kill << all_talk();
      if (has_guests) back_s.push_back((mono_now() - begin).as_seconds());
    }
    ASSERT_TRUE(all_hear_all(15)) << "kill " << kill << all_talk();
    seemed_to_leave += guests[0]->left != left_before ? 1 : 0;
    if (is_server)
      start_server(victim);
    else
      start_nats(victim, 3);
    dance(Duration::ms(2500));
    ASSERT_TRUE(all_hear_all(15)) << "after kill " << kill << all_talk();
  }
  std::sort(back_s.begin(), back_s.end());
  if (!back_s.empty())
    std::printf("guests back at another server: median %.2f s, longest %.2f s, of %zu kills\n",
                back_s[back_s.size() / 2], back_s.back(), back_s.size());
  std::printf("after %d of %d kills others seemed to leave for a moment\n", seemed_to_leave, kills);
  // Where NATS servers take longer than usual to agree who leads, as on a busy machine.
  EXPECT_LE(seemed_to_leave, 1 + kills / 10);
}

TEST_F(NatsCluster, WhatIsMissingIsOneLineThatNamesIt) {
  const auto refused = [&](const std::string& options) {
    const Finished server = run(bin("dance-server") + " --port 24499 " + options);
    EXPECT_EQ(server.exit_code, 1) << options;
    EXPECT_EQ(std::count(server.talk.begin(), server.talk.end(), '\n'), 1) << server.talk;
    return server.talk;
  };
  EXPECT_NE(refused("--cluster nats://me:secret@127.0.0.1:24999")
                .find("no NATS server answers at nats://127.0.0.1:24999"),
            std::string::npos)
      << "without the password";
  EXPECT_NE(refused("--cluster ,").find("--cluster names no NATS server"), std::string::npos);
}

}  // namespace
}  // namespace dance

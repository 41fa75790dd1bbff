// A cluster as an operator runs it: NATS with the shipped configuration, servers with rights of
// their own, keys that count and end everywhere, what status and doctor say, and restarts one after
// the other.
#include <csignal>

#include "tests/tunnel/operation/shipped_cluster.h"

namespace dance {
namespace {

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST_F(ClusterOperation, NatsTakesTheShippedConfiguration) {
  for (int i = 1; i <= kNats; ++i) {
    const std::string shipped =
        std::string(DANCE_SOURCE_DIR) + "/examples/cluster/nats-" + std::to_string(i) + ".conf";
    const Finished tested =
        run("cd " + folder_.path() + " && " + NATS_SERVER + " -t -c " + shipped);
    EXPECT_EQ(tested.exit_code, 0) << tested.talk << tested.output;
  }
}

TEST_F(ClusterOperation, WhoHasNoRightsIsOneClearLine) {
  // No user of NATS.
  const Finished stranger = run(server("stranger") + " --port 7409");
  EXPECT_EQ(stranger.exit_code, 1);
  EXPECT_EQ(lines_in(stranger.talk), 1u) << stranger.talk;
  EXPECT_NE(stranger.talk.find("does not let us in"), std::string::npos) << stranger.talk;
  EXPECT_NE(stranger.talk.find("stranger.pem"), std::string::npos) << stranger.talk;
  // Nor without a certificate, nor with another authority's.
  const Finished nobody = run(bin("dance-server") + " --port 7409 --cluster tls://127.0.0.1:4222" +
                              " --cluster-authorities " + folder_.path("ca.pem"));
  EXPECT_EQ(nobody.exit_code, 1);
  EXPECT_EQ(lines_in(nobody.talk), 1u) << nobody.talk;
  std::string another = server("dance-server") + " --port 7409";
  replace_all(another, "ca.pem", "stranger.pem");
  const Finished other = run(another);
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_EQ(lines_in(other.talk), 1u) << other.talk;
  // A server makes no keys, and an operator is no server.
  ASSERT_EQ(run(server("dance-operator") + " --new-guest alice").exit_code, 0);
  const Finished server_writes = run(server("dance-server") + " --new-guest mallory");
  EXPECT_EQ(server_writes.exit_code, 1);
  EXPECT_TRUE(server_writes.output.empty()) << "a key that nobody has";
  EXPECT_NE(server_writes.talk.find("ermission"), std::string::npos) << server_writes.talk;
  const Finished server_revokes = run(server("dance-server") + " --remove-key alice");
  EXPECT_EQ(server_revokes.exit_code, 1);
  const Finished listed = run(server("dance-server") + " --list-keys");
  EXPECT_NE(listed.output.find("alice"), std::string::npos) << listed.talk;
  EXPECT_EQ(listed.output.find("mallory"), std::string::npos);
  const Finished operator_serves = run(server("dance-operator") + " --port 7409");
  EXPECT_EQ(operator_serves.exit_code, 1);
  EXPECT_EQ(lines_in(operator_serves.talk), 1u) << operator_serves.talk;
}

TEST_F(ClusterOperation, AKeyCountsAtAllServersAndEndsAtAllOfThem) {
  start_server(1);
  start_server(2);
  for (const int i : {1, 2})
    ASSERT_TRUE(comes_true(i, [](const auto& now) { return alive_in(now) == 1; }))
        << talk_of("server-1") << talk_of("server-2");
  // Each guest at a server of her own, of keys that no server's file has.
  for (const int i : {1, 2}) {
    const std::string name = i == 1 ? "alice" : "bob";
    const std::string house = "XDG_CONFIG_HOME=" + folder_.path(name) + " ";
    const std::string address = "127.0.0.1:" + std::to_string(7400 + i);
    const Finished made = run(server("dance-operator") + " --new-guest " + name + " --address " +
                              address + " | " + house + bin("dance-key"));
    ASSERT_EQ(made.exit_code, 0) << made.talk;
    start("link-" + name, "/bin/sh",
          {"-c", house + "exec " + bin("dance-link") + " --server " + address + " --room salsa" +
                     " --guest " + name + " --bus 'udpm://239.255.76.67:774" + std::to_string(i) +
                     "?ttl=0'"});
  }
  for (const int i : {1, 2}) {
    EXPECT_TRUE(comes_true(i,
                           [](const auto& now) {
                             return links_of(now) == 1 && now["cluster"]["between"].size() == 1 &&
                                    now["cluster"]["between"][0]["guests"] == 1;
                           }))
        << talk_of("server-1") << status_of(i).dump(1) << talk_of("link-alice");
  }
  EXPECT_EQ(status_of(1)["cluster"]["keys"], 2);
  const Finished twice = run(server("dance-operator") + " --new-guest alice");
  EXPECT_EQ(twice.exit_code, 1);
  EXPECT_NE(twice.talk.find("has a key or an invitation already"), std::string::npos) << twice.talk;
  // One key is taken away: her session ends, and the other's does not.
  ASSERT_EQ(run(server("dance-operator") + " --remove-key alice").exit_code, 0);
  EXPECT_TRUE(comes_true(1, [](const auto& now) { return links_of(now) == 0; }))
      << status_of(1).dump(1);
  EXPECT_TRUE(comes_true(2, [](const auto& now) {
    return links_of(now) == 1 && now["cluster"]["keys"] == 1;
  })) << status_of(2).dump(1);
  const std::string table = run(bin("dance-status") + " --cluster --once --port 7402").output;
  EXPECT_NE(table.find("NATS: connected yes"), std::string::npos) << table;
  EXPECT_NE(table.find("this one"), std::string::npos) << table;
}

TEST_F(ClusterOperation, AServerThatLosesNatsKeepsItsKeysAndLearnsWhatItMissed) {
  ASSERT_EQ(run(server("dance-operator") + " --new-guest alice").exit_code, 0);
  start_server(1);
  ASSERT_TRUE(comes_true(1, [](const auto& now) { return now["cluster"]["keys"] == 1; }))
      << talk_of("server-1");
  for (int i = 1; i <= kNats; ++i) kill_program("nats-" + std::to_string(i));
  ASSERT_TRUE(comes_true(
      1, [](const auto& now) { return now["cluster"]["nats_keys"]["connected"] == false; }));
  EXPECT_EQ(status_of(1)["cluster"]["keys"], 1);
  for (int i = 1; i <= kNats; ++i) start_nats(i);
  // While nothing was told to this server: it may be back only after that.
  ASSERT_TRUE(wait_for(
      [&] { return run(server("dance-operator") + " --remove-key alice").exit_code == 0; }));
  EXPECT_TRUE(comes_true(1,
                         [](const auto& now) {
                           return now["cluster"]["nats_keys"]["connected"] == true &&
                                  now["cluster"]["keys"] == 0;
                         }))
      << status_of(1).dump(1) << talk_of("server-1");
  EXPECT_NE(talk_of("server-1").find("NATS answers again"), std::string::npos);
}

// Rolling restart, as far as servers alone can show it: the others go on, on the same clock, and
// the new one has keys, peers and the time before it takes links.
TEST_F(ClusterOperation, ServersAreRestartedOneAfterTheOtherAndTheClockGoesOn) {
  ASSERT_EQ(run(server("dance-operator") + " --new-guest alice").exit_code, 0);
  for (const int i : {1, 2, 3}) start_server(i);
  for (const int i : {1, 2, 3})
    ASSERT_TRUE(comes_true(i, [](const auto& now) {
      return alive_in(now) == 2 && !now["cluster"]["clock_offset_ms"].is_null();
    })) << talk_of("server-1");
  std::map<int, int> steps;
  for (const int i : {1, 2, 3}) steps[i] = status_of(i)["cluster"]["clock_steps"];
  for (const int restarted : {1, 2, 3}) {
    const std::string name = "server-" + std::to_string(restarted);
    programs_.at(name)->stop(Duration::s(5));
    EXPECT_TRUE(programs_.at(name)->ended_well()) << talk_of(name);
    const int other = restarted % 3 + 1;
    EXPECT_TRUE(comes_true(other, [](const auto& now) { return alive_in(now) == 1; }))
        << status_of(other).dump(1) << talk_of("server-" + std::to_string(other));
    start_server(restarted);
    for (const int i : {1, 2, 3}) {
      ASSERT_TRUE(comes_true(i, [](const auto& now) {
        return alive_in(now) == 2 && now["cluster"]["keys"] == 1;
      })) << talk_of(name);
    }
    // One jump when it joins, and none at those that were there.
    steps[restarted] = status_of(restarted)["cluster"]["clock_steps"];
    for (const int i : {1, 2, 3})
      EXPECT_EQ(status_of(i)["cluster"]["clock_steps"], steps[i]) << i << " when " << restarted;
  }
}

TEST_F(ClusterOperation, TheDoctorFindsWhatIsWrong) {
  start_server(1);
  start_server(2);
  for (const int i : {1, 2})
    ASSERT_TRUE(comes_true(i, [](const auto& now) { return alive_in(now) == 1; }));
  const Finished healthy = run(command("dance-doctor", "dance-server") + " --json");
  EXPECT_EQ(healthy.exit_code, 0) << healthy.output << healthy.talk;
  const auto found = nlohmann::json::parse(healthy.output, nullptr, false);
  std::map<std::string, int> grades;
  std::size_t servers = 0;
  for (const auto& finding : found["findings"]) {
    ++grades[finding["grade"]];
    const std::string name = finding["name"];
    servers += name.starts_with("server ") ? 1 : 0;
    if (!name.starts_with("copies")) continue;
    EXPECT_NE(finding["what"].get<std::string>().find("3 of 3"), std::string::npos) << finding;
  }
  EXPECT_EQ(grades["problem"], 0) << healthy.output;
  EXPECT_EQ(servers, 2u) << healthy.output;
  EXPECT_NE(healthy.output.find("this user makes and revokes no keys"), std::string::npos);
  // It leaves nothing behind.
  EXPECT_EQ(lines_in(run(server("dance-operator") + " --list-keys").output), 1u);

  const Finished stranger = run(command("dance-doctor", "stranger"));
  EXPECT_EQ(stranger.exit_code, 1);
  EXPECT_NE(stranger.output.find("does not let us in"), std::string::npos) << stranger.output;
  kill_program("nats-3");
  const Finished hurt =
      run_until(command("dance-doctor", "dance-server"), [](const Finished& finished) {
        return finished.output.find("2 of 3 NATS servers") != std::string::npos;
      });
  EXPECT_NE(hurt.output.find("one more that fails"), std::string::npos) << hurt.output;
}

}  // namespace
}  // namespace dance

// The programs that listen to a bus, run as a user runs them while a couple dances on it.
#include "tests/apps/bus_programs.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace dance {
namespace {

TEST_F(BusPrograms, TopTellsWhatIsOnTheBus) {
  open_house();
  const std::vector<const char*> words{"POSE/capture/alice", "POSE/stage/bob",
                                       "SKELETON/stage/bob", "pose_t",
                                       "skeleton_t",         "manager"};
  const Finished top = run_until(bin("dance-top") + " --once --bus " + quoted(kBus),
                                 [&](const Finished& it) { return has_all(it.output, words); });
  EXPECT_EQ(top.exit_code, 0) << top.talk;
  for (const char* word : words)
    EXPECT_NE(top.output.find(word), std::string::npos) << word << "\n" << top.output;
}

TEST_F(BusPrograms, LatencyTellsTheStepsOfAJourney) {
  open_house();
  const Finished table = run(bin("dance-latency") + " --seconds 1 --bus " + quoted(kBus));
  EXPECT_EQ(table.exit_code, 0) << table.talk;
  EXPECT_NE(table.output.find("alice"), std::string::npos) << table.output;

  const Finished one =
      run(bin("dance-latency") + " --seconds 1 --json --guest bob --bus " + quoted(kBus));
  const auto json = nlohmann::json::parse(one.output, nullptr, false);
  ASSERT_TRUE(json.is_object()) << one.output;
  ASSERT_EQ(json["guests"].size(), 1u);
  EXPECT_EQ(json["guests"][0]["id"], "bob");
  EXPECT_GT(json["guests"][0]["poses"].get<int>(), 0);
  EXPECT_GE(json["guests"][0]["steps"].size(), 3u);
}

TEST_F(BusPrograms, LatencyOfAnEmptyBusSaysSo) {
  const Finished empty = run(bin("dance-latency") + " --seconds 0.3 --bus " + quoted(kOtherBus));
  EXPECT_EQ(empty.exit_code, 1);
  EXPECT_NE(empty.talk.find("dance top"), std::string::npos) << empty.talk;
}

TEST_F(BusPrograms, ReplayTakesWordForAFileThatItGuessesWrong) {
  const std::string file = DANCE_SOURCE_DIR "/tests/formats/bvh/data/blender.bvh";
  ASSERT_TRUE(std::filesystem::exists(file));
  const auto hips_m = [&](const std::string& options) {
    ChildProcess& replay = start("/bin/sh", {"-c", "exec " + bin("dance-replay") + " " + file +
                                                       " --bus " + quoted(kBus) + " " + options});
    const Finished heard = run_until(
        bin("dance-listen") + " --where capture --to csv --seconds 0.5 --bus " + quoted(kBus),
        [](const Finished& it) { return lines_of(it, "alice") > 0; });
    replay.stop(Duration::s(2));
    const std::size_t row = heard.output.rfind(",alice,");
    if (row == std::string::npos) ADD_FAILURE() << heard.output << heard.talk;
    // …,guest,sequence,presence,confidence,music_beats,hips_x_m,hips_y_m
    std::size_t at = row;
    for (int comma = 0; comma < 6 && at != std::string::npos; ++comma)
      at = heard.output.find(',', at + 1);
    return at == std::string::npos ? 0.0 : std::strtod(heard.output.c_str() + at + 1, nullptr);
  };
  const double in_metres = hips_m("--unit m");
  EXPECT_NEAR(hips_m("--unit dm"), 0.1 * in_metres, 0.02 * in_metres);
}

TEST_F(BusPrograms, JoinNeedsNoMoreThanAServerAGuestAndARoom) {
  start("dance-server", {"--port", "7442", "--bind", "127.0.0.1"});
  for (const auto& [guest, bus] : {std::pair{"alice", kBus}, {"bob", kOtherBus}}) {
    start("dance-join",
          {"127.0.0.1:7442", "--guest", guest, "--room", "salsa", "--bus", bus, "--no-view"});
    start("dance-salsa", {"--guest", guest, "--bus", bus});
  }
  expect_couple_on_stage(kBus);
  expect_couple_on_stage(kOtherBus);
}

TEST_F(BusPrograms, SpyPrintsACommandWithOurTypes) {
  const Finished spy = run(bin("dance-spy") + " --print --bus " + quoted(kBus));
  if (spy.exit_code == 1) {
    EXPECT_NE(spy.talk.find("apt-get install"), std::string::npos) << spy.talk;
    GTEST_SKIP() << spy.talk;
  }
  EXPECT_NE(spy.output.find("dance_types.jar"), std::string::npos) << spy.output;
  EXPECT_NE(spy.output.find(kBus), std::string::npos) << spy.output;
}

TEST_F(BusPrograms, NameTheCureInOneLineIfLoopbackIsDown) {
  for (const std::string program :
       {"dance-top --once", "dance-record -o /dev/null", "dance-salsa --seconds 1",
        "dance-listen --seconds 1", "dance-latency --seconds 1", "dance-link --guest alice"}) {
    const Finished refused =
        run("unshare -rn " + bin(program) + " --bus 'udpm://239.255.76.67:7667?ttl=0'");
    EXPECT_EQ(refused.exit_code, 1) << program;
    EXPECT_EQ(std::count(refused.talk.begin(), refused.talk.end(), '\n'), 1) << refused.talk;
    EXPECT_NE(refused.talk.find("ip link set lo up"), std::string::npos) << refused.talk;
  }
}

TEST_F(BusPrograms, WhatIsMissingBrokenOrTakenIsOneLineThatNamesIt) {
  const std::string broken = folder_.path("broken.bvh"), session = folder_.path("house.toml");
  std::ofstream(broken) << "HIERARCHY\nROOT Hips\n{\n  OFFSET 0 zero 0\n";
  std::ofstream(session) << "[house]\nrooom = \"salsa\"\n";
  start("dance-server", {"--port", "7443", "--bind", "127.0.0.1"});
  ASSERT_TRUE(wait_for([] {  // 7443 in this network's table
    return text_of("/proc/net/udp").find(":1D13 ") != std::string::npos;
  })) << "the server did not open: "
      << text_of(folder_.path("talk"));
  for (const auto& [program, word] :
       {std::pair<std::string, std::string>{"dance-replay /nowhere/take.bvh", "/nowhere/take.bvh"},
        {"dance-replay " + broken, "line 4"},
        {"dance-join " + session, ":2"},
        {"dance-manager /nowhere/house.toml", "/nowhere/house.toml"},
        {"dance-server --bind 127.0.0.1 --port 7443", "7443"},
        {"dance-link --guest alice --server no-such-host.invalid", "no-such-host.invalid"},
        {"dance-unpack /nowhere/log.lcm -o " + folder_.path("out.lcm"), "/nowhere/log.lcm"},
        {"dance-pack " DANCE_SOURCE_DIR "/logs/couple.lcm -o /nowhere/out.lcm", "/nowhere/out.lcm"},
        {"dance-top --once --bus http://nowhere", "http://nowhere"}}) {
    const Finished refused = run(bin(program));
    EXPECT_EQ(refused.exit_code, 1) << program << refused.talk;
    EXPECT_EQ(std::count(refused.talk.begin(), refused.talk.end(), '\n'), 1) << refused.talk;
    EXPECT_NE(refused.talk.find(word), std::string::npos) << program << ": " << refused.talk;
  }
}

TEST_F(BusPrograms, WrongOptionsAreOneLineAndTwo) {
  for (const std::string program :
       {"dance-top --bus", "dance-record --seconds soon", "dance-listen --to stone",
        "dance-latency --guest Bob", "dance-salsa --guest Bob", "dance-link --guest Bob",
        "dance-join host --guest Bob", "dance-server --port 70000", "dance-replay", "dance-spy x",
        "dance-doctor --colour", "dance-manager a b", "dance-unpack some.lcm",
        "dance-pack -o some.lcm"}) {
    const Finished refused = run(bin(program));
    EXPECT_EQ(refused.exit_code, 2) << program << refused.talk;
    EXPECT_EQ(std::count(refused.talk.begin(), refused.talk.end(), '\n'), 1) << refused.talk;
    EXPECT_NE(refused.talk.find("--help"), std::string::npos) << refused.talk;
  }
}

}  // namespace
}  // namespace dance

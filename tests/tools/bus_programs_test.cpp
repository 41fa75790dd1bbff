// The programs that listen to a bus, run as a user runs them while a couple dances on it; and LCM's own logger and
// player in their place.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>
#include <vector>

#include "core/bus/log_file.h"
#include "tests/tools/run_program.h"
#include "tools/child_process.h"

namespace dance {
namespace {

constexpr const char* kBus = "udpm://239.255.76.67:7742?ttl=0";
constexpr const char* kOtherBus = "udpm://239.255.76.67:7743?ttl=0";

std::string quoted(const char* bus) { return std::string("'") + bus + "'"; }

class BusPrograms : public ::testing::Test {
 protected:
  // Runs until the test ends.
  ChildProcess& start(const std::string& program, std::vector<std::string> arguments) {
    const bool is_ours = program.starts_with("dance-");
    auto child = ChildProcess::start({is_ours ? bin(program) : program, std::move(arguments),
                                      folder_.path("output"), folder_.path("talk")});
    if (!child) ADD_FAILURE() << child.error().what;
    return children_.emplace_back(std::move(*child));
  }

  // A house with a synthetic couple in it, and time to open.
  void open_house(const char* bus = kBus) {
    std::ofstream(folder_.path("house.toml"))
        << "[house]\nbus = \"" << bus << "\"\nguests = [\"alice\", \"bob\"]\n"
        << "[[produce]]\nkind = \"salsa\"\nguest = \"alice\"\nrole = \"lead\"\n"
        << "[[produce]]\nkind = \"salsa\"\nguest = \"bob\"\nrole = \"follow\"\n"
        << "[[route]]\nfrom = \"POSE/capture/*\"\nto = \"POSE/stage/*\"\n";
    start("dance-manager", {folder_.path("house.toml")});
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
  }

  void end_all() {
    for (ChildProcess& child : children_) child.stop(Duration::s(5));
    children_.clear();
  }

  TestFolder folder_{"bus-programs"};
  std::vector<ChildProcess> children_;
};

// How many messages of each channel a log holds.
std::map<std::string, int> count_log(const std::string& path) {
  std::map<std::string, int> counts;
  auto log = LogReader::open(path);
  if (!log) {
    ADD_FAILURE() << log.error().what;
    return counts;
  }
  while (const auto event = log->next()) ++counts[std::string(event->channel)];
  return counts;
}

// A picture of the stage while somebody plays: the viewer says by its exit code that it heard dancers.
void expect_viewer_sees_dancers(const TestFolder& folder, const char* bus) {
  if (!std::filesystem::exists(bin("dance-view"))) return;  // built without a viewer
  // A graphics driver's own memory counts as lost in a program that ends with the driver unloaded; the viewer's own
  // tests look for leaks with the driver pinned.
  const Finished view = run("ASAN_OPTIONS=detect_leaks=0 " + bin("dance-view") +
                            " --headless --quality low --size 160x90 --at 1 --out " +
                            folder.path("pictures") + " --bus " + quoted(bus));
  if (view.talk.find("EGL") != std::string::npos) return;  // no driver that can draw
  EXPECT_EQ(view.exit_code, 0) << view.talk;
  EXPECT_TRUE(std::filesystem::exists(folder.path("pictures/stage-0001.png"))) << view.talk;
}

// Poses a second and distinct dancers that dance-listen hears on the stage within so many seconds.
void expect_couple_on_stage(const char* bus, double seconds, double least_hz) {
  const Finished heard = run(bin("dance-listen") + " --to csv --seconds " +
                             std::to_string(seconds) + " --bus " + quoted(bus));
  ASSERT_EQ(heard.exit_code, 0) << heard.talk;
  const auto lines_of = [&](const std::string& guest) {
    int lines = 0;
    for (std::size_t at = 0;
         (at = heard.output.find("," + guest + ",", at + 1)) != std::string::npos;)
      ++lines;
    return lines;
  };
  EXPECT_GT(lines_of("alice"), least_hz * seconds) << heard.output.substr(0, 500);
  EXPECT_GT(lines_of("bob"), least_hz * seconds);
}

TEST_F(BusPrograms, TopTellsWhatIsOnTheBus) {
  open_house();
  const Finished top = run(bin("dance-top") + " --once --bus " + quoted(kBus));
  EXPECT_EQ(top.exit_code, 0) << top.talk;
  for (const char* word : {"POSE/capture/alice", "POSE/stage/bob", "SKELETON/stage/bob", "pose_t",
                           "skeleton_t", "manager"})
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
  EXPECT_GT(json["guests"][0]["poses"].get<int>(), 10);
  EXPECT_GE(json["guests"][0]["steps"].size(), 3u);
}

TEST_F(BusPrograms, LatencyOfAnEmptyBusSaysSo) {
  const Finished empty = run(bin("dance-latency") + " --seconds 0.3 --bus " + quoted(kOtherBus));
  EXPECT_EQ(empty.exit_code, 1);
  EXPECT_NE(empty.talk.find("dance top"), std::string::npos) << empty.talk;
}

TEST_F(BusPrograms, RecordWritesALogThatReplayPlaysLive) {
  open_house();
  const std::string log = folder_.path("evening.lcm");
  const Finished record =
      run(bin("dance-record") + " -o " + log + " --seconds 2 --bus " + quoted(kBus));
  ASSERT_EQ(record.exit_code, 0) << record.talk;
  auto counts = count_log(log);
  EXPECT_GT(counts["POSE/stage/alice"], 30);
  EXPECT_GT(counts["POSE/capture/bob"], 30);
  EXPECT_GT(counts["SKELETON/stage/bob"], 0);

  const Finished again =
      run(bin("dance-record") + " -o " + log + " --seconds 1 --bus " + quoted(kBus));
  EXPECT_EQ(again.exit_code, 1) << "an evening is not overwritten";
  EXPECT_NE(again.talk.find("evening.lcm"), std::string::npos) << again.talk;

  end_all();
  start("dance-replay", {log, "--bus", kOtherBus});
  expect_couple_on_stage(kOtherBus, 2.0, 3.0);
  expect_viewer_sees_dancers(folder_, kOtherBus);
}

// All of a log's events: channel and bytes.
std::set<std::string> events_of_log(const std::string& path) {
  std::set<std::string> events;
  auto log = LogReader::open(path);
  if (!log) {
    ADD_FAILURE() << log.error().what;
    return events;
  }
  while (const auto event = log->next())
    events.insert(std::string(event->channel) + "\n" +
                  std::string(event->data.begin(), event->data.end()));
  return events;
}

TEST_F(BusPrograms, RecordPackedHoldsThatVeryDanceInHalfTheBytesAndReplays) {
  open_house();
  const std::string plain = folder_.path("plain.lcm"), packed = folder_.path("packed.lcm"),
                    again = folder_.path("again.lcm");
  const std::string channels = " --channels 'POSE/.*' 'SKELETON/.*' --bus " + quoted(kBus);
  ChildProcess& beside =
      start("/bin/sh", {"-c", "exec " + bin("dance-record") + " -o " + plain + channels});
  const auto has_begun = [&] {
    std::error_code error;
    const auto size = std::filesystem::file_size(plain, error);
    return !error && size > 0;
  };
  for (int i = 0; i < 100 && !has_begun(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const Finished record =
      run(bin("dance-record") + " --packed -o " + packed + " --seconds 2" + channels);
  ASSERT_EQ(record.exit_code, 0) << record.talk;
  EXPECT_NE(record.output.find("messages packed, 0 not"), std::string::npos) << record.output;
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  beside.stop(Duration::s(5));
  end_all();

  const Finished unpack = run(bin("dance-unpack") + " " + packed + " -o " + again);
  ASSERT_EQ(unpack.exit_code, 0) << unpack.talk;
  EXPECT_LT(2 * std::filesystem::file_size(packed), std::filesystem::file_size(again));
  // The plain recorder began before and ended after: what it did not hear, its own socket lost.
  const std::set<std::string> heard = events_of_log(plain), held = events_of_log(again);
  const auto both = std::count_if(held.begin(), held.end(),
                                  [&](const std::string& event) { return heard.contains(event); });
  EXPECT_GT(held.size(), 200u);
  EXPECT_GT(static_cast<double>(both), 0.9 * static_cast<double>(held.size()));
  EXPECT_EQ(count_log(packed).count("POSE/stage/alice"), 0u);
  EXPECT_GT(count_log(again)["POSE/stage/alice"], 30);

  start("dance-replay", {packed, "--bus", kOtherBus});
  expect_couple_on_stage(kOtherBus, 2.0, 3.0);
}

TEST_F(BusPrograms, APackedLogThatLcmsOwnPlayerPlaysDisturbsNobody) {
  if (run("command -v lcm-logplayer").exit_code != 0)
    GTEST_SKIP() << "lcm-logplayer is not installed";
  open_house();
  const std::string log = folder_.path("packed.lcm"), copy = folder_.path("copy.lcm");
  ASSERT_EQ(run(bin("dance-record") + " --packed -o " + log +
                " --channels 'POSE/.*' --seconds 5 --bus " + quoted(kBus))
                .exit_code,
            0);
  end_all();
  start("/usr/bin/lcm-logplayer", {std::string("--lcm-url=") + kOtherBus, log});
  const Finished heard =
      run(bin("dance-listen") + " --to csv --seconds 0.5 --bus " + quoted(kOtherBus));
  EXPECT_EQ(heard.exit_code, 0) << heard.talk;
  EXPECT_EQ(heard.output.find(",alice,"), std::string::npos) << "no pose of hers is on the bus";
  const Finished top = run(bin("dance-top") + " --once --bus " + quoted(kOtherBus));
  EXPECT_NE(top.output.find("PACKED/POSE/stage/alice"), std::string::npos) << top.output;
}

TEST_F(BusPrograms, RecordKeepsOnlyTheChannelsAskedFor) {
  open_house();
  const std::string log = folder_.path("stage.lcm");
  const Finished record = run(bin("dance-record") + " -o " + log +
                              " --seconds 1 --channels 'POSE/stage/.*' --bus " + quoted(kBus));
  ASSERT_EQ(record.exit_code, 0) << record.talk;
  for (const auto& [channel, count] : count_log(log))
    EXPECT_TRUE(channel.starts_with("POSE/stage/")) << channel;
}

TEST_F(BusPrograms, ALogOfLcmsOwnLoggerIsReadAndReplayed) {
  if (run("command -v lcm-logger").exit_code != 0) GTEST_SKIP() << "lcm-logger is not installed";
  open_house();
  const std::string log = folder_.path("logger.lcm");
  ChildProcess& logger = start("/usr/bin/lcm-logger", {std::string("--lcm-url=") + kBus, log});
  std::this_thread::sleep_for(std::chrono::seconds(2));
  logger.stop(Duration::s(5));
  end_all();
  auto counts = count_log(log);
  EXPECT_GT(counts["POSE/stage/alice"], 30);
  EXPECT_GT(counts["POSE/capture/bob"], 30);

  start("dance-replay", {log, "--bus", kOtherBus});
  expect_couple_on_stage(kOtherBus, 1.5, 3.0);
}

TEST_F(BusPrograms, LcmsOwnPlayerBringsARecordedCoupleBackOnStage) {
  if (run("command -v lcm-logplayer").exit_code != 0)
    GTEST_SKIP() << "lcm-logplayer is not installed";
  open_house();
  const std::string log = folder_.path("ours.lcm");
  ASSERT_EQ(
      run(bin("dance-record") + " -o " + log + " --seconds 4 --bus " + quoted(kBus)).exit_code, 0);
  end_all();
  start("/usr/bin/lcm-logplayer", {std::string("--lcm-url=") + kOtherBus, log});
  expect_couple_on_stage(kOtherBus, 1.5, 3.0);
  expect_viewer_sees_dancers(folder_, kOtherBus);
}

TEST_F(BusPrograms, ReplayTakesWordForAFileThatItGuessesWrong) {
  const std::string file = DANCE_SOURCE_DIR "/tests/core_pose/data/blender.bvh";
  ASSERT_TRUE(std::filesystem::exists(file));
  const auto hips_m = [&](const std::string& options) {
    ChildProcess& replay = start("/bin/sh", {"-c", "exec " + bin("dance-replay") + " " + file +
                                                       " --bus " + quoted(kBus) + " " + options});
    const Finished heard =
        run(bin("dance-listen") + " --where capture --to csv --seconds 0.5 --bus " + quoted(kBus));
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
  std::this_thread::sleep_for(std::chrono::seconds(2));
  expect_couple_on_stage(kBus, 1.5, 3.0);
  expect_couple_on_stage(kOtherBus, 1.5, 3.0);
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

TEST_F(BusPrograms, ABusWithoutARouteIsOneLineWithTheCure) {
  // A network of its own in which nothing is up.
  for (const std::string program :
       {"dance-top --once", "dance-record -o /dev/null", "dance-salsa --seconds 1",
        "dance-listen --seconds 1", "dance-latency --seconds 1", "dance-link --guest alice"}) {
    const Finished refused =
        run("unshare -rn " + bin(program) + " --bus 'udpm://239.255.76.67:7667?ttl=0'");
    EXPECT_EQ(refused.exit_code, 1) << program;
    EXPECT_EQ(std::count(refused.talk.begin(), refused.talk.end(), '\n'), 1) << refused.talk;
    EXPECT_NE(refused.talk.find("ip route add"), std::string::npos) << program << refused.talk;
  }
}

TEST_F(BusPrograms, WhatIsMissingBrokenOrTakenIsOneLineThatNamesIt) {
  const std::string broken = folder_.path("broken.bvh"), session = folder_.path("house.toml");
  std::ofstream(broken) << "HIERARCHY\nROOT Hips\n{\n  OFFSET 0 zero 0\n";
  std::ofstream(session) << "[house]\nrooom = \"salsa\"\n";
  start("dance-server", {"--port", "7443", "--bind", "127.0.0.1"});
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  for (const auto& [program, word] :
       {std::pair<std::string, std::string>{"dance-replay /nowhere/take.bvh", "/nowhere/take.bvh"},
        {"dance-replay " + broken, "line 4"},
        {"dance-join " + session, ":2"},
        {"dance-manager /nowhere/house.toml", "/nowhere/house.toml"},
        {"dance-server --bind 127.0.0.1 --port 7443", "7443"},
        {"dance-link --guest alice --server no-such-host.invalid", "no-such-host.invalid"},
        {"dance-unpack /nowhere/log.lcm -o " + folder_.path("out.lcm"), "/nowhere/log.lcm"},
        {"dance-pack " + session + " -o /nowhere/out.lcm", "/nowhere/out.lcm"},
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

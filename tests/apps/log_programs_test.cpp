// The programs that write and play recordings, run as a user runs them while a couple dances; and
// LCM's own logger and player in their place.
#include <gtest/gtest.h>

#include <map>

#include "core/bus/encode.h"
#include "formats/log/log_file.h"
#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

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

// A picture of the stage while somebody plays: the viewer says by its exit code that it heard
// dancers.
void expect_viewer_sees_dancers(const TestFolder& folder, const char* bus) {
  if (!std::filesystem::exists(bin("dance-view"))) return;  // built without a viewer
  // A graphics driver's own memory counts as lost in a program that ends with the driver unloaded;
  // the viewer's own tests look for leaks with the driver pinned.
  const Finished view =
      run_until("ASAN_OPTIONS=detect_leaks=0 " + bin("dance-view") +
                    " --headless --quality low --size 160x90 --at 1 --focus ghost --out " +
                    folder.path("pictures") + " --bus " + quoted(bus),
                [](const Finished& it) {
                  return it.exit_code == 0 || it.talk.find("EGL") != std::string::npos;
                });
  if (view.talk.find("EGL") != std::string::npos) return;  // no driver that can draw
  EXPECT_EQ(view.exit_code, 0) << view.talk;
  EXPECT_TRUE(std::filesystem::exists(folder.path("pictures/stage-0001.png"))) << view.talk;
  EXPECT_NE(view.talk.find("--focus ghost: "), std::string::npos) << view.talk;
}

TEST_F(BusPrograms, RecordWritesALogThatReplayPlaysLive) {
  open_house();
  const std::string log = folder_.path("evening.lcm");
  const Finished record =
      run(bin("dance-record") + " -o " + log + " --seconds 2 --bus " + quoted(kBus));
  ASSERT_EQ(record.exit_code, 0) << record.talk;
  EXPECT_TRUE(is_private(log));
  auto counts = count_log(log);
  EXPECT_GT(counts["POSE/stage/alice"], 5);
  EXPECT_GT(counts["POSE/capture/bob"], 5);
  EXPECT_GT(counts["SKELETON/stage/bob"], 0);

  const Finished again =
      run(bin("dance-record") + " -o " + log + " --seconds 1 --bus " + quoted(kBus));
  EXPECT_EQ(again.exit_code, 1) << "an evening is not overwritten";
  EXPECT_NE(again.talk.find("evening.lcm"), std::string::npos) << again.talk;

  end_all();
  start("dance-replay", {log, "--bus", kOtherBus});
  expect_couple_on_stage(kOtherBus);
  expect_viewer_sees_dancers(folder_, kOtherBus);
}

// The bytes of each pose that a log holds, by channel and sequence.
std::map<std::pair<std::string, std::uint32_t>, std::string> poses_of_log(const std::string& path) {
  std::map<std::pair<std::string, std::uint32_t>, std::string> poses;
  auto log = LogReader::open(path);
  if (!log) {
    ADD_FAILURE() << log.error().what;
    return poses;
  }
  Pose pose;
  while (const auto event = log->next())
    if (decode(event->data.data(), event->data.size(), pose) == Decoded::kFine)
      poses.emplace(std::pair(std::string(event->channel), pose.sequence),
                    std::string(event->data.begin(), event->data.end()));
  return poses;
}

TEST_F(BusPrograms, RecordPackedHoldsThatVeryDanceInFewerBytesAndReplays) {
  open_house();
  const std::string plain = folder_.path("plain.lcm"), packed = folder_.path("packed.lcm"),
                    again = folder_.path("again.lcm");
  const std::string channels = " --channels 'POSE/.*' 'SKELETON/.*' --bus " + quoted(kBus);
  ChildProcess& beside =
      start("/bin/sh", {"-c", "exec " + bin("dance-record") + " -o " + plain + channels});
  const auto size_of = [](const std::string& path) {
    std::error_code error;
    const auto size = std::filesystem::file_size(path, error);
    return error ? 0 : size;
  };
  ASSERT_TRUE(wait_for([&] { return size_of(plain) > 0; })) << "the plain recorder hears nothing";
  const Finished record =
      run(bin("dance-record") + " --packed -o " + packed + " --seconds 2" + channels);
  ASSERT_EQ(record.exit_code, 0) << record.talk;
  EXPECT_NE(record.output.find("messages packed, 0 not"), std::string::npos) << record.output;
  beside.stop(Duration::s(5));
  end_all();

  const Finished unpack = run(bin("dance-unpack") + " " + packed + " -o " + again);
  ASSERT_EQ(unpack.exit_code, 0) << unpack.talk;
  for (const std::string& file : {plain, packed, again}) EXPECT_TRUE(is_private(file)) << file;
  // By how much depends on the poses a second that this machine manages; packed_log_test knows a
  // fixed dance's.
  EXPECT_LT(size_of(packed), size_of(again));
  // Each of the two may have lost what the other heard; what both heard is the same.
  const auto heard = poses_of_log(plain), held = poses_of_log(again);
  std::size_t heard_by_both = 0;
  for (const auto& [which, bytes] : held) {
    const auto same = heard.find(which);
    if (same == heard.end()) continue;
    ++heard_by_both;
    EXPECT_TRUE(same->second == bytes) << which.first << " " << which.second;
  }
  EXPECT_GT(heard_by_both, 10u) << heard.size() << " heard, " << held.size() << " held";
  EXPECT_EQ(count_log(packed).count("POSE/stage/alice"), 0u);
  EXPECT_GT(count_log(again)["POSE/stage/alice"], 5);

  start("dance-replay", {packed, "--bus", kOtherBus});
  expect_couple_on_stage(kOtherBus);
}

TEST_F(BusPrograms, ReplayPlaysRecordingsOfOtherKindsAsTheyAre) {
  for (const std::string end : {"mcap", "csv"}) {
    const std::string file = folder_.path("couple." + end), log = folder_.path(end + ".lcm");
    const Finished converted =
        run(bin("dance-convert") + " " DANCE_SOURCE_DIR "/logs/couple-packed.lcm " + file);
    ASSERT_EQ(converted.exit_code, 0) << converted.talk;
    start("dance-replay", {file, "--bus", kOtherBus});
    int poses = 0;
    const std::string record_anew = "rm -f " + log + " && " + bin("dance-record") + " -o " + log +
                                    " --seconds 1 --bus " + quoted(kOtherBus);
    const Finished record = run_until(record_anew, [&](const Finished& it) {
      poses = 0;
      if (it.exit_code != 0) return false;
      for (const auto& [channel, count] : count_log(log))
        if (channel.starts_with("POSE/") && channel.ends_with("/alice")) poses += count;
      return poses > 5;
    });
    EXPECT_GT(poses, 5) << end << ": " << record.talk;
    end_all();
  }
}

TEST_F(BusPrograms, RecordSaysThatItHeardNothing) {
  const std::string log = folder_.path("silence.lcm");
  const std::string record =
      bin("dance-record") + " --seconds 0.5 --bus " + quoted(kBus) + " -o " + log;
  const Finished silent = run(record);
  EXPECT_EQ(silent.exit_code, 0);
  EXPECT_TRUE(has_all(silent.talk, {"nothing was heard on ", "silence.lcm is empty"}))
      << silent.talk;
  const Finished more = run(record + " --append");
  EXPECT_TRUE(has_all(more.talk, {"nothing was heard on ", "silence.lcm is as it was"}))
      << more.talk;
}

TEST_F(BusPrograms, PackOfWhatIsNoLogSaysNoSizesAndIsNotInTheWayOfTheNextTry) {
  open_house();
  const std::string notes = folder_.path("notes.txt"), log = folder_.path("evening.lcm"),
                    packed = folder_.path("packed.lcm");
  std::ofstream(notes) << "Tuesday: tango. Wednesday: none. Thursday: salsa, and on until three.\n";
  const Finished refused = run(bin("dance-pack") + " " + notes + " -o " + packed);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_EQ(refused.output, "");
  EXPECT_NE(refused.talk.find("notes.txt: is no LCM log"), std::string::npos) << refused.talk;
  // What the disk does not give is not taken for a log's end.
  const Finished broken = run(bin("dance-pack") + " /proc/self/mem -o " + packed);
  EXPECT_EQ(broken.exit_code, 1);
  EXPECT_NE(broken.talk.find("cannot be read to its end"), std::string::npos) << broken.talk;
  EXPECT_FALSE(std::filesystem::exists(packed + ".part"));
  ASSERT_EQ(
      run(bin("dance-record") + " -o " + log + " --seconds 0.5 --bus " + quoted(kBus)).exit_code,
      0);
  const Finished pack = run(bin("dance-pack") + " " + log + " -o " + packed);
  EXPECT_EQ(pack.exit_code, 0) << pack.talk;
  EXPECT_NE(pack.output.find("packed.lcm: "), std::string::npos) << pack.output;
  EXPECT_EQ(pack.talk, "");
}

TEST_F(BusPrograms, APackedLogThatLcmsOwnPlayerPlaysDisturbsNobody) {
  if (run("command -v lcm-logplayer").exit_code != 0)
    GTEST_SKIP() << "lcm-logplayer is not installed";
  open_house();
  const std::string log = folder_.path("packed.lcm");
  ASSERT_EQ(run(bin("dance-record") + " --packed -o " + log +
                " --channels 'POSE/.*' --seconds 2 --bus " + quoted(kBus))
                .exit_code,
            0);
  end_all();
  play_over_and_over(log, kOtherBus);
  const char* const channel = "PACKED/POSE/stage/alice";
  const Finished top = run_until(bin("dance-top") + " --once --bus " + quoted(kOtherBus),
                                 [&](const Finished& it) { return has_all(it.output, {channel}); });
  EXPECT_NE(top.output.find(channel), std::string::npos) << top.output;
  const Finished heard =
      run(bin("dance-listen") + " --to csv --seconds 1 --bus " + quoted(kOtherBus));
  EXPECT_EQ(heard.exit_code, 0) << heard.talk;
  EXPECT_EQ(lines_of(heard, "alice"), 0) << "no pose of hers is on the bus";
}

TEST_F(BusPrograms, RecordKeepsOnlyTheChannelsAskedFor) {
  open_house();
  const std::string log = folder_.path("stage.lcm");
  const Finished record = run(bin("dance-record") + " -o " + log +
                              " --seconds 1 --channels 'POSE/stage/.*' --bus " + quoted(kBus));
  ASSERT_EQ(record.exit_code, 0) << record.talk;
  const auto counts = count_log(log);
  EXPECT_EQ(counts.size(), 2u);
  for (const auto& [channel, count] : counts)
    EXPECT_TRUE(channel.starts_with("POSE/stage/")) << channel;
}

TEST_F(BusPrograms, ALogOfLcmsOwnLoggerIsReadAndReplayed) {
  if (run("command -v lcm-logger").exit_code != 0) GTEST_SKIP() << "lcm-logger is not installed";
  open_house();
  const std::string log = folder_.path("logger.lcm");
  ChildProcess& logger = start("/usr/bin/lcm-logger", {std::string("--lcm-url=") + kBus, log});
  ASSERT_TRUE(wait_for([&] {
    std::error_code error;
    const auto size = std::filesystem::file_size(log, error);
    return !error && size > 100'000;
  })) << "lcm-logger writes nothing";
  logger.stop(Duration::s(5));
  end_all();
  auto counts = count_log(log);
  EXPECT_GT(counts["POSE/stage/alice"], 5);
  EXPECT_GT(counts["POSE/capture/bob"], 5);

  start("dance-replay", {log, "--bus", kOtherBus});
  expect_couple_on_stage(kOtherBus);
}

TEST_F(BusPrograms, LcmsOwnPlayerBringsARecordedCoupleBackOnStage) {
  if (run("command -v lcm-logplayer").exit_code != 0)
    GTEST_SKIP() << "lcm-logplayer is not installed";
  open_house();
  const std::string log = folder_.path("ours.lcm");
  ASSERT_EQ(
      run(bin("dance-record") + " -o " + log + " --seconds 4 --bus " + quoted(kBus)).exit_code, 0);
  end_all();
  play_over_and_over(log, kOtherBus);
  expect_couple_on_stage(kOtherBus);
  expect_viewer_sees_dancers(folder_, kOtherBus);
}

}  // namespace
}  // namespace dance

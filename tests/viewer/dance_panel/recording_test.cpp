// Recording by a program beside the window: where to, how long, and what is said when it fails.
#include "viewer/dance_panel/recording.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "tests/test_folder.h"

namespace dance {
namespace {

constexpr MonoTime kRecordingBegin = MonoTime::from_us(1'000'000);

std::tm evening() {
  std::tm local{};
  local.tm_year = 126;
  local.tm_mon = 10;
  local.tm_mday = 26;
  local.tm_hour = 8;
  local.tm_min = 5;
  return local;
}

TEST(RecordingFile, IsNamedAfterDateAndTimeAndOverwritesNothing) {
  const auto none = [](const std::string&) { return false; };
  EXPECT_EQ(dance_file("/v", evening(), ".lcm", none), "/v/dance-2026-11-26-0805.lcm");
  std::set<std::string> there{"/v/dance-2026-11-26-0805.lcm", "/v/dance-2026-11-26-0805-2.lcm"};
  const auto is_there = [&](const std::string& path) { return there.contains(path); };
  EXPECT_EQ(dance_file("/v", evening(), ".lcm", is_there), "/v/dance-2026-11-26-0805-3.lcm");
  EXPECT_EQ(dance_file("/v", evening(), ".png", is_there), "/v/dance-2026-11-26-0805.png");
  EXPECT_EQ(dance_file("/v", evening(), ".png", [](const std::string&) { return true; }),
            std::nullopt);
}

TEST(RecordingsFolder, IsWhereAPersonLooks) {
  std::map<std::string, std::string> environment{{"HOME", "/home/ann"}};
  const Environment get = [&](const char* name) -> const char* {
    const auto it = environment.find(name);
    return it == environment.end() ? nullptr : it->second.c_str();
  };
  using Folders = std::vector<std::string>;
  EXPECT_EQ(recordings_folder(get), "/home/ann/Videos/DanceGraph");
  EXPECT_EQ(older_recordings_folders(get),
            (Folders{"/home/ann/Videos", "/home/ann/.local/share/dance/recordings"}));
  environment["XDG_DATA_HOME"] = "/data";
  environment["XDG_VIDEOS_DIR"] = "/films";
  EXPECT_EQ(recordings_folder(get), "/films/DanceGraph");
  EXPECT_EQ(older_recordings_folders(get),
            (Folders{"/films", "/home/ann/Videos", "/data/dance/recordings",
                     "/home/ann/.local/share/dance/recordings"}));
  environment["XDG_VIDEOS_DIR"] = "films";  // a relative one means nothing
  EXPECT_EQ(recordings_folder(get), "/home/ann/Videos/DanceGraph");
  environment.clear();
  EXPECT_EQ(recordings_folder(get), "");
  EXPECT_TRUE(older_recordings_folders(get).empty());
}

// A program that stands for dance record.
class RecordingTest : public testing::Test {
 protected:
  void write_program(const std::string& body) {
    std::ofstream(program()) << "#!/bin/sh\n" << body;
    ASSERT_EQ(chmod(program().c_str(), 0755), 0);
  }
  std::string program() const { return folder_.path("dance-record"); }
  std::string target() const { return folder_.path("videos"); }
  DanceRecording::Options options() const { return {program(), target(), "a-bus"}; }
  // Until it ends by itself, however fast the machine is.
  static void wait_until_idle(DanceRecording& recording, MonoTime now) {
    for (int i = 0; i < 3000 && recording.state() != DanceRecording::State::kIdle; ++i) {
      recording.work(now);
      usleep(10'000);
    }
  }
  TestFolder folder_{"dance-recording"};
};

TEST_F(RecordingTest, RunsUntilItIsStoppedAndNamesItsFile) {
  write_program(
      "trap 'exit 0' TERM\n"
      "echo \"$@\" > \"$2\"\n"
      "while :; do sleep 0.02; done\n");
  DanceRecording recording(options());
  recording.start(kRecordingBegin);
  ASSERT_EQ(recording.state(), DanceRecording::State::kRunning) << recording.trouble();
  EXPECT_EQ(recording.elapsed(kRecordingBegin + Duration::s(65)), Duration::s(65));
  EXPECT_TRUE(recording.file().starts_with(target() + "/dance-20"));
  for (int i = 0; i < 3000 && !std::filesystem::exists(recording.file()); ++i) usleep(10'000);
  ASSERT_TRUE(std::filesystem::exists(recording.file()));
  recording.stop(kRecordingBegin);
  EXPECT_EQ(recording.state(), DanceRecording::State::kStopping);
  wait_until_idle(recording, kRecordingBegin);
  EXPECT_EQ(recording.state(), DanceRecording::State::kIdle);
  EXPECT_TRUE(recording.is_saved()) << recording.trouble();
  EXPECT_EQ(recording.trouble(), "");
  EXPECT_EQ(text_of(recording.file()), "-o " + recording.file() + " --packed --bus a-bus\n");
}

TEST_F(RecordingTest, TellsInOneLineWhyItEnded) {
  write_program(
      "echo 'recording to x' >&2\n"
      "echo 'x: cannot be written: No space left on device' >&2\n"
      "exit 1\n");
  DanceRecording recording(options());
  recording.start(kRecordingBegin);
  wait_until_idle(recording, kRecordingBegin);
  EXPECT_EQ(recording.trouble(), "x: cannot be written: No space left on device");
  EXPECT_FALSE(recording.is_saved());
  recording.forget_trouble();
  EXPECT_EQ(recording.trouble(), "");
}

TEST_F(RecordingTest, WhatAProgramSaysIsBoundedAndPrintable) {
  write_program(
      "i=0\n"
      "while [ $i -lt 2000 ]; do printf 'word\\033[31m'; i=$((i+1)); done >&2\n"
      "exit 1\n");
  DanceRecording recording(options());
  recording.start(kRecordingBegin);
  wait_until_idle(recording, kRecordingBegin);
  EXPECT_FALSE(recording.trouble().empty());
  EXPECT_LT(recording.trouble().size(), 900u);
  EXPECT_EQ(recording.trouble().find('\033'), std::string::npos);
}

TEST_F(RecordingTest, NamesAProgramThatIsMissingAndAFolderThatCannotBeMade) {
  DanceRecording missing(options());
  missing.start(kRecordingBegin);
  EXPECT_EQ(missing.state(), DanceRecording::State::kIdle);
  EXPECT_NE(missing.trouble().find("cannot be run"), std::string::npos) << missing.trouble();
  write_program("exit 0\n");
  std::ofstream(folder_.path("file")) << "no folder\n";
  DanceRecording::Options nowhere = options();
  nowhere.folder = folder_.path("file") + "/videos";
  DanceRecording recording(nowhere);
  recording.start(kRecordingBegin);
  EXPECT_EQ(recording.state(), DanceRecording::State::kIdle);
  EXPECT_NE(recording.trouble().find("videos"), std::string::npos) << recording.trouble();
}

TEST_F(RecordingTest, OneThatDoesNotEndIsKilled) {
  write_program("trap '' TERM\necho ready > \"$2\"\nwhile :; do sleep 0.02; done\n");
  DanceRecording recording(options());
  recording.start(kRecordingBegin);
  for (int i = 0; i < 3000 && !std::filesystem::exists(recording.file()); ++i) usleep(10'000);
  recording.stop(kRecordingBegin);
  wait_until_idle(recording, kRecordingBegin + Duration::s(6));
  EXPECT_EQ(recording.state(), DanceRecording::State::kIdle);
  EXPECT_FALSE(recording.is_saved());
  EXPECT_FALSE(recording.trouble().empty());
}

}  // namespace
}  // namespace dance

// What dance capture keeps: every message in its order, or counted; and no files of a recording
// that never began.
#include "producers/camera/program/capture_recording.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "formats/media/media_module.h"

namespace dance {
namespace {

class CountingSink : public CaptureSink {
 public:
  void capture(const GuestId&, Pose&, MonoTime) override { ++poses; }
  void capture(const GuestId&, const Hands&) override {}
  void capture(const GuestId&, const TimedSkeleton&) override {}
  std::int64_t poses = 0;
};

std::string take_for(const std::string& name) {
  const std::string folder = std::string(DANCE_BINARY_DIR) + "/capture-recording-test/" + name;
  std::filesystem::remove_all(folder);
  return folder;
}

TEST(CaptureRecording, KeepsEveryMessageInItsOrderOrCountsIt) {
  if (const auto media = media_module(); !media) GTEST_SKIP() << media.error().what;
  const std::string folder = take_for("order");
  CountingSink bus;
  auto recording = CaptureRecording::create(folder, 30.0, bus);
  ASSERT_TRUE(recording) << recording.error().what;
  const GuestId mei = GuestId::parse("mei").value();
  constexpr std::int64_t kPoses = 5000;  // more than wait at a time
  Pose pose;
  for (std::int64_t i = 1; i <= kPoses; ++i) {
    pose.capture_time = MonoTime::from_us(i);
    (*recording)->capture(mei, pose, pose.capture_time);
  }
  (*recording)->finish();
  EXPECT_EQ(bus.poses, kPoses) << "the bus gets all";
  EXPECT_EQ((*recording)->trouble(), "");
  auto log = LogReader::open(folder + "/poses.lcm");
  ASSERT_TRUE(log) << log.error().what;
  std::int64_t events = 0;
  std::int64_t last_us = 0;
  while (const auto event = log->next()) {
    ++events;
    EXPECT_EQ(event->channel, "POSE/capture/mei");
    RawPose read;
    ASSERT_TRUE(decode_unchecked(event->data.data(), event->data.size(), read));
    EXPECT_GT(read.capture_time_us, last_us);
    last_us = read.capture_time_us;
  }
  EXPECT_EQ(last_us, kPoses) << "the newest is never the one that is left out";
  EXPECT_EQ(log->skipped_bytes(), 0u);
  const std::string told = std::to_string(events) + " events in poses.lcm (" +
                           std::to_string(kPoses - events) + " left out)";
  EXPECT_NE((*recording)->summary().find(told), std::string::npos) << (*recording)->summary();
}

TEST(CaptureRecording, WhatNeverBeganLeavesTheFolderFree) {
  if (const auto media = media_module(); !media) GTEST_SKIP() << media.error().what;
  const std::string folder = take_for("again");
  CountingSink bus;
  for (int i = 0; i < 2; ++i) {
    const auto recording = CaptureRecording::create(folder, 30.0, bus);
    ASSERT_TRUE(recording) << recording.error().what;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  // The table cannot be made where a link to nowhere stands: the log, made before, goes again.
  std::filesystem::create_symlink("/nowhere/at/all", folder + "/video.mkv.tsv");
  ASSERT_FALSE(CaptureRecording::create(folder, 30.0, bus));
  EXPECT_FALSE(std::filesystem::exists(folder + "/poses.lcm"));
  std::filesystem::remove(folder + "/video.mkv.tsv");
  EXPECT_TRUE(CaptureRecording::create(folder, 30.0, bus));
}

TEST(CaptureRecording, RefusesAFolderThatHasAnyOfItsFiles) {
  for (const char* name : {"video.mkv", "video.mkv.tsv", "poses.lcm"}) {
    const std::string folder = take_for("taken");
    std::filesystem::create_directories(folder);
    std::ofstream(folder + "/" + name) << "of somebody";
    CountingSink bus;
    const auto refused = CaptureRecording::create(folder, 30.0, bus);
    ASSERT_FALSE(refused) << name;
    EXPECT_NE(refused.error().what.find("name another folder"), std::string::npos);
    EXPECT_EQ(std::filesystem::file_size(folder + "/" + name), 11u) << "untouched";
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1) << name;
  }
}

}  // namespace
}  // namespace dance

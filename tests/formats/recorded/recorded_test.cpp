#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core/pose/skeleton.h"
#include "formats/bvh/bvh.h"
#include "formats/log/unpacked_log.h"
#include "formats/recorded/recorded_file.h"
#include "formats/recorded/recording_log.h"
#include "formats/recording/log_sink.h"
#include "tests/formats/mcap/mcap_sample.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

constexpr const char* kMixamoBvh = DANCE_SOURCE_DIR "/tests/formats/bvh/data/mixamo.bvh";

class RecordedFiles : public testing::Test {
 protected:
  std::string write(const std::string& name, std::string_view bytes) {
    std::ofstream(folder_.path(name), std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return folder_.path(name);
  }
  static std::size_t poses_of(const std::string& path, std::string* lost = nullptr) {
    const auto file = RecordedFile::open(path);
    if (!file) return 0;
    Recording recording;
    EXPECT_TRUE((*file)->read_into(recording).has_value());
    if (lost) *lost = (*file)->lost();
    std::size_t poses = 0;
    for (const RecordedGuest& guest : recording.guests()) poses += guest.poses.size();
    return poses;
  }
  TestFolder folder_{"recorded"};
};

TEST_F(RecordedFiles, BecomeATemporaryLogForPlayers) {
  const McapBytes bytes = mcap_of(recorded_night(20));
  const std::string path =
      write("night", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  std::string gone;
  {
    const auto log = RecordingLog::open(path);
    ASSERT_TRUE(log.has_value()) << log.error().what;
    EXPECT_TRUE(log->is_made());
    gone = log->path();
    EXPECT_EQ(poses_of(gone), poses_of(path));
    EXPECT_GT(poses_of(gone), 0u);
  }
  EXPECT_FALSE(UnpackedLog::open(gone).has_value());
}

TEST_F(RecordedFiles, UseAUnitForClipsAndRefuseItForOtherKinds) {
  RecordedFileOptions options;
  options.retarget.metres_per_unit = 0.005;
  const auto file = RecordedFile::open(kMixamoBvh, options);
  ASSERT_TRUE(file.has_value()) << file.error().what;
  Recording half, whole;
  ASSERT_TRUE((*file)->read_into(half).has_value());
  options.retarget.metres_per_unit = 0.01;
  ASSERT_TRUE((*RecordedFile::open(kMixamoBvh, options))->read_into(whole).has_value());
  EXPECT_NEAR(standing_height_m(half.guests().front().skeleton()),
              0.5f * standing_height_m(whole.guests().front().skeleton()), 1e-3f);
  const McapBytes bytes = mcap_of(recorded_night(2));
  const auto mcap = RecordedFile::open(
      write("night.mcap", {reinterpret_cast<const char*>(bytes.data()), bytes.size()}), options);
  ASSERT_FALSE(mcap.has_value());
  EXPECT_NE(mcap.error().what.find("--unit and --up are for BVH and glTF"), std::string::npos);
}

TEST_F(RecordedFiles, RefuseAPipeThatNobodyWritesTo) {
  const std::string path = folder_.path("night.lcm");
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  const auto file = RecordedFile::open(path);
  ASSERT_FALSE(file.has_value());
  EXPECT_EQ(file.error().what,
            path + ": is a pipe or a device; save the recording as a file, and name that");
}

// A log is looked through before it is read, and must not count its damage twice.
TEST_F(RecordedFiles, CountTheDamageOfALogOnce) {
  auto writer = LogWriter::create(folder_.path("night.lcm"));
  ASSERT_TRUE(writer.has_value());
  LogSink sink(std::move(*writer), Where::kCapture);
  recorded_night(10).play_into(sink);
  ASSERT_TRUE(sink.finish().has_value());
  std::string bytes = text_of(folder_.path("night.lcm"));
  std::vector<std::size_t> events;
  for (std::size_t at = bytes.find("\xED\xA1\xDA\x01"); at != bytes.npos;
       at = bytes.find("\xED\xA1\xDA\x01", at + 1))
    events.push_back(at);
  bytes.insert(events[events.size() / 2], std::string(4096, '\x55'));
  std::string lost;
  EXPECT_EQ(poses_of(write("junk.lcm", bytes), &lost), poses_of(folder_.path("night.lcm")));
  EXPECT_EQ(lost, "4096 bytes that are no event");
}

TEST_F(RecordedFiles, GiveTheWholeFramesOfACutBvh) {
  const std::string text = text_of(kMixamoBvh);
  std::string lost;
  const std::size_t all = poses_of(kMixamoBvh, &lost);
  EXPECT_EQ(lost, "");
  ASSERT_GT(all, 1u);
  const std::size_t end = text.find_last_not_of(" \r\n");
  EXPECT_EQ(poses_of(write("cut.bvh", text.substr(0, end - 20)), &lost), all - 1);
  EXPECT_NE(lost.find("it was cut short"), std::string::npos) << lost;
}

TEST_F(RecordedFiles, HoldThePoseOfASingleFrame) {
  auto bvh = read_bvh(text_of(kMixamoBvh));
  ASSERT_TRUE(bvh.has_value());
  std::string text = text_of(kMixamoBvh);
  text.replace(text.find("Frames:"), text.find('\n', text.find("Frames:")) - text.find("Frames:"),
               "Frames: 1");
  const std::size_t first = text.find('\n', text.find("Frame Time:")) + 1;
  text.resize(text.find('\n', first) + 1);
  std::string lost;
  EXPECT_EQ(poses_of(write("one.bvh", text), &lost), 1u);
  EXPECT_EQ(lost, "");
}

}  // namespace
}  // namespace dance

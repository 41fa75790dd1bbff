#include "formats/bvh/clip_file.h"

#include <gtest/gtest.h>
#include <lzma.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

const std::string kSample = DANCE_SOURCE_DIR "/tests/formats/bvh/data/vrm.bvh";

// A directory of this test's own that goes with it.
class ClipFile : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }
  static std::string error_of(const std::string& file) {
    const auto clip = load_clip(file);
    return clip ? "no error" : clip.error().what;
  }

 private:
  TestFolder folder_{"clip-file"};
};

std::string xz(const std::string& text) {
  std::string packed(lzma_stream_buffer_bound(text.size()), '\0');
  std::size_t size = 0;
  EXPECT_EQ(lzma_easy_buffer_encode(
                6, LZMA_CHECK_CRC64, nullptr, reinterpret_cast<const std::uint8_t*>(text.data()),
                text.size(), reinterpret_cast<std::uint8_t*>(packed.data()), &size, packed.size()),
            LZMA_OK);
  packed.resize(size);
  return packed;
}

TEST_F(ClipFile, LoadsABvhAndSaysWhatItGuessed) {
  const auto clip = load_clip(kSample);
  ASSERT_TRUE(clip.has_value()) << clip.error().what;
  EXPECT_EQ(clip->clip.frames.size(), 3u);
  EXPECT_DOUBLE_EQ(clip->clip.frame_hz, 30.0);
  EXPECT_FALSE(clip->notes.empty());
}

TEST_F(ClipFile, LoadsTheSameFromXzUnderAnyName) {
  const auto plain = load_clip(kSample);
  for (const char* name : {"take.bvh.xz", "take.bvh", "take"}) {
    const auto packed = load_clip(write(name, xz(text_of(kSample))));
    ASSERT_TRUE(packed.has_value()) << packed.error().what;
    EXPECT_EQ(packed->clip.frames[2].p_WH_m, plain->clip.frames[2].p_WH_m);
    EXPECT_EQ(packed->clip.skeleton, plain->clip.skeleton);
  }
}

TEST_F(ClipFile, LoadsXzStreamsThatFollowEachOther) {
  const std::string text = text_of(kSample);
  const auto clip =
      load_clip(write("two.bvh.xz", xz(text.substr(0, 1000)) + xz(text.substr(1000))));
  ASSERT_TRUE(clip.has_value()) << clip.error().what;
  EXPECT_EQ(clip->clip.frames.size(), 3u);
}

TEST_F(ClipFile, NamesTheFileAndTheCure) {
  EXPECT_EQ(error_of(path("no.bvh")), path("no.bvh") + ": no such file");
  EXPECT_EQ(error_of(path("")), path("") + ": a folder; name a file in it");
  EXPECT_EQ(error_of("/dev/null"), "/dev/null: no regular file");
  EXPECT_EQ(error_of(write("empty.bvh", "")), path("empty.bvh") + ": empty; copy it again");
  EXPECT_EQ(error_of(write("page.bvh", "<html>")),
            path("page.bvh") +
                ": line 1: '<html>' stands where HIERARCHY should: this is not a BVH file");
  EXPECT_EQ(error_of(write("plain.bvh.xz", text_of(kSample))),
            path("plain.bvh.xz") + ": no xz file inside; rename or pack it with xz");
}

TEST_F(ClipFile, DoesNotWaitForAPipe) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_EQ(error_of(path("pipe")), path("pipe") + ": no regular file");
}

TEST_F(ClipFile, SaysThatAnXzFileWasCutShortOrDamaged) {
  std::string packed = xz(text_of(kSample));
  // The sample is one block of which nothing comes out before its end.
  EXPECT_EQ(error_of(write("cut.bvh.xz", packed.substr(0, packed.size() / 8))),
            path("cut.bvh.xz") + ": the xz file is cut short; copy it again");
  packed[packed.size() / 2] = static_cast<char>(packed[packed.size() / 2] ^ 1);
  EXPECT_EQ(error_of(write("hurt.bvh.xz", packed)),
            path("hurt.bvh.xz") + ": the xz file is damaged; copy it again");
}

TEST_F(ClipFile, KeepsTheWholeFramesOfAnXzFileThatIsCutShort) {
  // 400 frames that pack badly: most of the packed file is motion.
  const std::string sample = text_of(kSample);
  const std::size_t motion = sample.find("MOTION");
  const std::string last_line = sample.substr(sample.rfind('\n', sample.size() - 2) + 1);
  const auto channels = std::count(last_line.begin(), last_line.end(), ' ') + 1;
  std::string text = sample.substr(0, motion) + "MOTION\nFrames: 400\nFrame Time: 0.0333333\n";
  Random random(42);
  for (int f = 0; f < 400; ++f)
    for (int c = 0; c < channels; ++c)
      text += std::to_string(random.uniform(-9.0, 9.0)) + (c + 1 < channels ? " " : "\n");
  const std::string packed = xz(text);
  const auto whole = load_clip(write("whole.bvh.xz", packed));
  ASSERT_TRUE(whole) << whole.error().what;
  ASSERT_EQ(whole->clip.frames.size(), 400u);
  const auto cut = load_clip(write("cut.bvh.xz", packed.substr(0, packed.size() * 3 / 4)));
  ASSERT_TRUE(cut) << cut.error().what;
  EXPECT_GT(cut->clip.frames.size(), 200u);
  EXPECT_LT(cut->clip.frames.size(), 320u);
  EXPECT_EQ(cut->lost.rfind("the xz file is cut short; copy it again; line ", 0), 0u) << cut->lost;
  EXPECT_NE(cut->lost.find(" of 400; it was cut short"), std::string::npos) << cut->lost;
  // Only the index at the end is missing.
  const auto endless = load_clip(write("endless.bvh.xz", packed.substr(0, packed.size() - 5)));
  ASSERT_TRUE(endless) << endless.error().what;
  EXPECT_EQ(endless->clip.frames.size(), 400u);
  EXPECT_EQ(endless->lost, "the xz file is cut short; copy it again");
}

TEST_F(ClipFile, RefusesEveryPrefixOfAnXzFile) {
  const std::string packed = xz(text_of(kSample));
  for (std::size_t size = 1; size < packed.size(); size += 7) {
    const auto text = read_clip_text(write("cut.bvh.xz", packed.substr(0, size)));
    EXPECT_FALSE(text.has_value()) << "first " << size << " bytes";
  }
}

TEST_F(ClipFile, BoundsWhatAFileUnpacksTo) {
  const std::string file = write("bomb.bvh.xz", xz(std::string(std::size_t{8} << 20, ' ')));
  EXPECT_LT(fs::file_size(file), 10'000u);
  const auto text = read_clip_text(file, std::size_t{1} << 20);
  ASSERT_FALSE(text.has_value());
  EXPECT_EQ(text.error().what, file + ": unpacks to more than 1 MiB");
  EXPECT_TRUE(read_clip_text(file, std::size_t{8} << 20).has_value());
}

TEST_F(ClipFile, BoundsWhatItReads) {
  const std::string file = write("large.bvh", std::string((std::size_t{1} << 20) + 1, ' '));
  const auto text = read_clip_text(file, std::size_t{1} << 20);
  ASSERT_FALSE(text.has_value());
  EXPECT_EQ(text.error().what, file + ": larger than 1 MiB");
}

}  // namespace
}  // namespace dance

// What a build without FFmpeg says of a song that libsndfile cannot read.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "producers/music/decode/audio_file.h"
#include "tests/producers/music/wav_file.h"

namespace dance {
namespace {

class WithoutFfmpeg : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  const std::string path_ = (std::filesystem::temp_directory_path() /
                             ("without_ffmpeg_test." + std::to_string(::getpid()) + ".m4a"))
                                .string();
};

TEST_F(WithoutFfmpeg, NamesTheFileAndThePackages) {
  std::ofstream(path_) << std::string(
                              "\0\0\0\x1c"
                              "ftypM4A ",
                              12)
                       << std::string(64, '\0');
  const auto audio = AudioFile::open(path_);
  ASSERT_FALSE(audio);
  EXPECT_EQ(audio.error().what,
            path_ +
                ": libsndfile cannot read it, and this dance was built without FFmpeg; install "
                "libavformat-dev libavcodec-dev libavutil-dev libswresample-dev and build "
                "again, or convert it to .flac");
}

TEST_F(WithoutFfmpeg, DoesNotAdviseToConvertAFileToWhatItIs) {
  const std::string damaged = path_ + ".flac";
  std::ofstream(damaged) << "fLaC and nothing else";
  const auto audio = AudioFile::open(damaged);
  std::filesystem::remove(damaged);
  ASSERT_FALSE(audio);
  EXPECT_TRUE(audio.error().what.ends_with("or convert it to .wav")) << audio.error().what;
}

TEST_F(WithoutFfmpeg, ReadsWhatLibsndfileReads) {
  write_wav(path_, std::vector<float>(100, 0.25f), 1, 44100);
  const auto audio = AudioFile::open(path_);
  ASSERT_TRUE(audio) << audio.error().what;
  EXPECT_EQ(audio->length_frames(), 100);
}

}  // namespace
}  // namespace dance

// What is said where the media module is missing, of another version or broken: of a song that
// libsndfile cannot read, and in general.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "formats/media/media_module.h"
#include "producers/music/decode/audio_file.h"
#include "tests/producers/music/wav_file.h"

namespace dance {
namespace {

class WithoutMedia : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  const std::string path_ = (std::filesystem::temp_directory_path() /
                             ("without_media_test." + std::to_string(::getpid()) + ".m4a"))
                                .string();
};

TEST_F(WithoutMedia, NamesTheFileAndThePackages) {
  std::ofstream(path_) << std::string(
                              "\0\0\0\x1c"
                              "ftypM4A ",
                              12)
                       << std::string(64, '\0');
  const auto audio = AudioFile::open(path_);
  ASSERT_FALSE(audio);
  const std::string& said = audio.error().what;
  EXPECT_TRUE(said.starts_with(path_ + ": libsndfile cannot read it. FFmpeg is needed and not "
                                       "here: "))
      << said;
  EXPECT_TRUE(said.ends_with("; or convert it to .flac")) << said;
  EXPECT_TRUE(said.find("dancegraph-media") != std::string::npos ||
              said.find("libavformat-dev") != std::string::npos)
      << said;
}

TEST_F(WithoutMedia, DoesNotAdviseToConvertAFileToWhatItIs) {
  const std::string damaged = path_ + ".flac";
  std::ofstream(damaged) << "fLaC and nothing else";
  const auto audio = AudioFile::open(damaged);
  std::filesystem::remove(damaged);
  ASSERT_FALSE(audio);
  EXPECT_TRUE(audio.error().what.ends_with("or convert it to .wav")) << audio.error().what;
}

TEST_F(WithoutMedia, AFileThatIsNoModuleIsRefused) {
  std::ofstream(path_) << "no shared object";
  const auto module = media_module_from(path_);
  ASSERT_FALSE(module);
  EXPECT_NE(module.error().what.find("cannot be loaded"), std::string::npos) << module.error().what;
  EXPECT_NE(module.error().what.find(path_), std::string::npos) << module.error().what;
}

TEST_F(WithoutMedia, AModuleOfAnotherVersionIsRefused) {
  const auto module = media_module_from(DANCE_OTHER_MODULE);
  ASSERT_FALSE(module);
  EXPECT_NE(module.error().what.find("of another version"), std::string::npos)
      << module.error().what;
}

TEST_F(WithoutMedia, ReadsWhatLibsndfileReads) {
  write_wav(path_, std::vector<float>(100, 0.25f), 1, 44100);
  const auto audio = AudioFile::open(path_);
  ASSERT_TRUE(audio) << audio.error().what;
  EXPECT_EQ(audio->length_frames(), 100);
}

}  // namespace
}  // namespace dance

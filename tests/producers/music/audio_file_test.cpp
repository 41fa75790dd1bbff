#include "producers/music/decode/audio_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/producers/music/wav_file.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

class AudioFileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("audio_file_test." + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static std::string open_error(const std::string& file) {
    const auto audio = AudioFile::open(file);
    return audio ? "no error" : audio.error().what;
  }

 private:
  fs::path folder_;
};

// Sample n of the left channel tells n, the right one its negative half.
std::vector<float> counting_stereo(int frames) {
  std::vector<float> samples;
  for (int n = 0; n < frames; ++n) {
    const float left = static_cast<float>(n) / 32767.0f;
    samples.push_back(left);
    samples.push_back(-0.5f * left);
  }
  return samples;
}

TEST_F(AudioFileTest, GivesEverySampleOnceAsMonoAndAsStereo) {
  write_wav(path("count.wav"), counting_stereo(10000), 2, 22050);
  auto audio = AudioFile::open(path("count.wav"));
  ASSERT_TRUE(audio) << audio.error().what;
  EXPECT_EQ(audio->rate_hz(), 22050.0);
  EXPECT_EQ(audio->channels(), 2);
  EXPECT_EQ(audio->length_frames(), 10000);
  std::vector<float> mono(7001);
  std::int64_t n = 0;
  for (std::size_t read = 1; read > 0;) {
    const auto result = audio->read(mono);
    ASSERT_TRUE(result) << result.error().what;
    read = *result;
    for (std::size_t i = 0; i < read; ++i, ++n)
      ASSERT_NEAR(mono[i] * 32768.0f, 0.25f * static_cast<float>(n), 0.6f) << n;
  }
  EXPECT_EQ(n, 10000);
  EXPECT_EQ(audio->at_frame(), 10000);

  ASSERT_TRUE(audio->seek(123));
  std::vector<float> stereo(2 * 50);
  const auto read = audio->read_stereo(stereo);
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, 50u);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_NEAR(stereo[2 * i] * 32768.0f, 123.0f + static_cast<float>(i), 0.6f);
    EXPECT_NEAR(stereo[2 * i + 1] * 32768.0f, -0.5f * (123.0f + static_cast<float>(i)), 0.6f);
  }
}

TEST_F(AudioFileTest, PutsOneChannelOnBothSides) {
  write_wav(path("mono.wav"), std::vector<float>(100, 0.25f), 1, 44100);
  auto audio = AudioFile::open(path("mono.wav"));
  ASSERT_TRUE(audio);
  std::vector<float> stereo(200);
  ASSERT_EQ(audio->read_stereo(stereo).value(), 100u);
  for (const float sample : stereo) EXPECT_NEAR(sample, 0.25f, 1e-4f);
}

TEST_F(AudioFileTest, NamesTheFileAndTheCure) {
  EXPECT_EQ(open_error("/nowhere/song.ogg"), "/nowhere/song.ogg: no such file");
  EXPECT_NE(open_error("/tmp").find("no regular file"), std::string::npos);
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_NE(open_error(path("pipe")).find("no regular file"), std::string::npos);
  std::ofstream(path("text.ogg")) << "this is no music at all, whatever its name says";
  EXPECT_EQ(open_error(path("text.ogg")).find("to .ogg"), std::string::npos);
  EXPECT_EQ(open_error(path("text.ogg")).find(path("text.ogg")), 0u);
  write_wav(path("empty.wav"), {}, 1, 44100);
  EXPECT_NE(open_error(path("empty.wav")).find("empty"), std::string::npos);
}

TEST_F(AudioFileTest, SurvivesEveryTruncation) {
  const std::string whole = wav_bytes(counting_stereo(64), 2, 8000);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    std::ofstream(path("cut.wav"), std::ios::binary | std::ios::trunc) << whole.substr(0, size);
    auto audio = AudioFile::open(path("cut.wav"));
    if (!audio) continue;
    std::vector<float> mono(1000);
    const auto read = audio->read(mono);
    EXPECT_LE(read.value_or(0), 64u);
  }
}

}  // namespace
}  // namespace dance

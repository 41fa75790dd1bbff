#include "producers/music/decode/audio_file.h"

#include <gtest/gtest.h>
#include <sndfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/producers/music/wav_file.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

class AudioFileTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }
  static std::string open_error(const std::string& file) {
    const auto audio = AudioFile::open(file);
    return audio ? "no error" : audio.error().what;
  }

 private:
  TestFolder folder_{"audio-file"};
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

// Encoded by libsndfile.
void write_encoded(const std::string& file, int format, const std::vector<float>& mono,
                   int rate_hz) {
  SF_INFO info{};
  info.samplerate = rate_hz;
  info.channels = 1;
  info.format = format;
  SNDFILE* out = sf_open(file.c_str(), SFM_WRITE, &info);
  ASSERT_NE(out, nullptr) << sf_strerror(nullptr);
  const auto frames = static_cast<sf_count_t>(mono.size());
  EXPECT_EQ(sf_writef_float(out, mono.data(), frames), frames);
  sf_close(out);
}

std::vector<float> tone(std::size_t frames) {
  std::vector<float> mono(frames);
  for (std::size_t n = 0; n < frames; ++n)
    mono[n] = 0.5f * std::sin(0.05f * static_cast<float>(n) + 1e-6f * static_cast<float>(n * n));
  return mono;
}

std::vector<float> all_of(AudioFile& audio) {
  std::vector<float> all, block(5000);
  for (;;) {
    const auto read = audio.read(block);
    EXPECT_TRUE(read.has_value()) << read.error().what;
    if (!read || *read == 0) return all;
    all.insert(all.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(*read));
  }
}

// The whole file, its length, and the same samples after going back and on.
void expect_plays_to_its_end(const std::string& file, std::size_t frames) {
  auto audio = AudioFile::open(file);
  ASSERT_TRUE(audio.has_value()) << audio.error().what;
  EXPECT_EQ(audio->length_frames(), static_cast<std::int64_t>(frames));
  const std::vector<float> all = all_of(*audio);
  ASSERT_EQ(all.size(), frames);
  for (const std::size_t at : {frames / 2, std::size_t{0}, frames - 100}) {
    ASSERT_TRUE(audio->seek(static_cast<std::int64_t>(at)).has_value());
    std::vector<float> some(50);
    ASSERT_EQ(audio->read(some).value_or(0), some.size());
    for (std::size_t i = 0; i < some.size(); ++i)
      ASSERT_NEAR(some[i], all[at + i], 1e-6f) << file << " at " << at;
  }
}

TEST_F(AudioFileTest, PlaysAFlacWhoseLengthIsUnknown) {
  write_encoded(path("streamed.flac"), SF_FORMAT_FLAC | SF_FORMAT_PCM_16, tone(24000), 8000);
  std::string bytes = text_of(path("streamed.flac"));
  ASSERT_EQ(bytes.substr(0, 4), "fLaC");
  // The 36 bits of STREAMINFO with the number of samples.
  bytes[21] = static_cast<char>(bytes[21] & 0xF0);
  for (std::size_t i = 22; i < 26; ++i) bytes[i] = 0;
  std::ofstream(path("streamed.flac"), std::ios::binary | std::ios::trunc) << bytes;
  expect_plays_to_its_end(path("streamed.flac"), 24000);
}

TEST_F(AudioFileTest, PlaysACutOggToItsEnd) {
  write_encoded(path("song.ogg"), SF_FORMAT_OGG | SF_FORMAT_VORBIS, tone(200000), 44100);
  const std::string bytes = text_of(path("song.ogg"));
  std::ofstream(path("cut.ogg"), std::ios::binary) << bytes.substr(0, bytes.size() * 2 / 3);
  auto audio = AudioFile::open(path("cut.ogg"));
  ASSERT_TRUE(audio.has_value()) << audio.error().what;
  const auto frames = static_cast<std::size_t>(audio->length_frames());
  EXPECT_GT(frames, 50000u);
  EXPECT_LT(frames, 200000u);
  expect_plays_to_its_end(path("cut.ogg"), frames);
}

TEST_F(AudioFileTest, PlaysAWavWhoseRecorderWasKilled) {
  std::string bytes = wav_bytes(tone(20000), 1, 8000);
  for (const std::size_t at : {4, 40})
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = 0;
  std::ofstream(path("killed.wav"), std::ios::binary) << bytes;
  expect_plays_to_its_end(path("killed.wav"), 20000);
}

TEST_F(AudioFileTest, PlaysAFormatThatCannotSeek) {
  write_encoded(path("gsm.wav"), SF_FORMAT_WAV | SF_FORMAT_GSM610, tone(16000), 8000);
  expect_plays_to_its_end(path("gsm.wav"), 16000);
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

TEST_F(AudioFileTest, HasTheTitleOfItsTagsWithoutHiddenCharacters) {
  const auto title_with = [&](const char* title, const char* artist) {
    SF_INFO info{};
    info.samplerate = 8000;
    info.channels = 1;
    info.format = SF_FORMAT_FLAC | SF_FORMAT_PCM_16;
    SNDFILE* file = sf_open(path("tagged.flac").c_str(), SFM_WRITE, &info);
    EXPECT_NE(file, nullptr);
    if (title != nullptr) sf_set_string(file, SF_STR_TITLE, title);
    if (artist != nullptr) sf_set_string(file, SF_STR_ARTIST, artist);
    const std::vector<float> samples(800, 0.1f);
    sf_writef_float(file, samples.data(), 800);
    sf_close(file);
    auto audio = AudioFile::open(path("tagged.flac"));
    EXPECT_TRUE(audio) << audio.error().what;
    return audio ? audio->title() : "";
  };
  EXPECT_EQ(title_with("Quimbara", "Celia Cruz"), "Quimbara - Celia Cruz");
  EXPECT_EQ(title_with("Quimbara", nullptr), "Quimbara");
  EXPECT_EQ(title_with(" a\nb\u202e ", "  "), "a?b?");
  EXPECT_EQ(title_with(nullptr, "Celia Cruz"), "") << "no title";
  EXPECT_LE(title_with(std::string(5000, 'x').c_str(), nullptr).size(), kMostTag_bytes);
}

}  // namespace
}  // namespace dance

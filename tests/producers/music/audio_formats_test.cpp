// Songs as the `ffmpeg` program writes them, in every format that plays.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <sstream>

#include "producers/music/decode/audio_file.h"
#include "tests/producers/music/wav_file.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

constexpr int kSongRate_hz = 44100;
constexpr double kSong_s = 13.0;
constexpr double kFirst_s = 0.25, kPeriod_s = 0.5;
constexpr double kClose_s = 0.005;
constexpr const char* kDecoderPackages =
    "libavformat-dev libavcodec-dev libavutil-dev libswresample-dev";

std::vector<double> song_clicks_s() {
  std::vector<double> times_s;
  for (double at_s = kFirst_s; at_s < kSong_s - 0.1; at_s += kPeriod_s) times_s.push_back(at_s);
  return times_s;
}

std::string bytes_of(const std::string& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

class AudioFormats : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("ffmpeg -version >/dev/null 2>&1") != 0)
      GTEST_SKIP() << "no ffmpeg program, which makes the songs; apt-get install ffmpeg";
    folder_ = fs::temp_directory_path() / ("audio_formats_test." + std::to_string(::getpid()));
    fs::create_directories(folder_);
    write_wav(path("clicks.wav"), click_track(song_clicks_s(), kSong_s, kSongRate_hz), 1,
              kSongRate_hz);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  // `ffmpeg ARGUMENTS NAME` in the folder.
  std::string make(const std::string& arguments, const std::string& name) {
    const std::string command = "cd '" + folder_.string() + "' && ffmpeg -nostdin -v error -y " +
                                arguments + " " + name + " >ffmpeg.log 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << command << "\n" << bytes_of(path("ffmpeg.log"));
    return path(name);
  }

 private:
  fs::path folder_;
};

struct SongFile {
  const char* name;
  const char* arguments;
  bool needs_ffmpeg;
  std::int64_t seek_error_frames = 0;
};

std::ostream& operator<<(std::ostream& out, const SongFile& song) { return out << song.name; }

class SongFormat : public AudioFormats, public testing::WithParamInterface<SongFile> {
 protected:
  void SetUp() override {
    AudioFormats::SetUp();
#ifndef DANCE_HAVE_FFMPEG
    if (GetParam().needs_ffmpeg)
      GTEST_SKIP() << "built without FFmpeg; apt-get install " << kDecoderPackages;
#endif
  }
  std::string song() {
    make("-f lavfi -i color=red:s=64x64:r=1:d=1 -frames:v 1", "cover.png");
    return make(GetParam().arguments, GetParam().name);
  }
};

std::vector<float> samples_of(AudioFile& file) {
  std::vector<float> samples(static_cast<std::size_t>(file.length_frames()) + 4096);
  const auto read = file.read(samples);
  EXPECT_TRUE(read) << read.error().what;
  samples.resize(read.value_or(0));
  return samples;
}

TEST_P(SongFormat, HasItsClicksWhereTheWavHasThem) {
  const std::string path = song();
  testing::internal::CaptureStderr();
  auto file = AudioFile::open(path);
  const std::vector<float> samples = file ? samples_of(*file) : std::vector<float>();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_TRUE(file) << file.error().what;
  EXPECT_NEAR(file->length_s(), kSong_s, kClose_s);
  EXPECT_NEAR(static_cast<double>(samples.size()), static_cast<double>(file->length_frames()),
              static_cast<double>(GetParam().seek_error_frames));
  for (const double click_s : song_clicks_s()) {
    auto at = static_cast<std::size_t>((click_s - 0.1) * file->rate_hz());
    while (at < samples.size() && std::abs(samples[at]) < 0.3f) ++at;
    EXPECT_NEAR(static_cast<double>(at) / file->rate_hz(), click_s, kClose_s);
  }
}

TEST_P(SongFormat, ReadsTheSameAfterASeekAsWithoutOne) {
  auto file = AudioFile::open(song());
  ASSERT_TRUE(file) << file.error().what;
  const std::vector<float> samples = samples_of(*file);
  constexpr std::int64_t kEdge = 100;
  std::vector<float> again(3000);
  for (const double to_s : {0.01, 12.2, 0.3, 11.7, 4.1, 4.2, 8.9, 2.0, 1.01, 0.003}) {
    const auto frame = static_cast<std::int64_t>(to_s * file->rate_hz());
    ASSERT_TRUE(file->seek(frame));
    EXPECT_EQ(file->at_frame(), frame);
    ASSERT_EQ(file->read(again).value_or(0), again.size());
    const auto is_off_by = [&](std::int64_t off) {
      for (auto i = kEdge; i < static_cast<std::int64_t>(again.size()) - kEdge; ++i) {
        const std::int64_t at = std::clamp<std::int64_t>(
            frame + off + i, 0, static_cast<std::int64_t>(samples.size()) - 1);
        if (std::abs(again[static_cast<std::size_t>(i)] - samples[static_cast<std::size_t>(at)]) >
            1e-3f)
          return false;
      }
      return true;
    };
    std::int64_t off = 0;
    while (off <= GetParam().seek_error_frames && !is_off_by(off) && !is_off_by(-off)) ++off;
    EXPECT_LE(off, GetParam().seek_error_frames) << "at " << to_s << " s";
  }
  ASSERT_TRUE(file->seek(0));
  ASSERT_EQ(file->read(again).value_or(0), again.size());
  EXPECT_TRUE(std::equal(again.begin(), again.end(), samples.begin()));
  ASSERT_TRUE(file->seek(file->length_frames()));
  EXPECT_EQ(file->read(again).value_or(1), 0u);
}

INSTANTIATE_TEST_SUITE_P(
    AsFfmpegWritesThem, SongFormat,
    testing::Values(
        SongFile{"song.mp3", "-i clicks.wav", false},
        SongFile{"cover.mp3", "-i clicks.wav -i cover.png -map 0 -map 1 -c:v copy -id3v2_version 3",
                 false},
        SongFile{"song.flac", "-i clicks.wav", false},
        SongFile{"song.opus", "-i clicks.wav", false},
        // libsndfile is off by the padding of the last page when it enters there.
        SongFile{"song.ogg", "-i clicks.wav", false, 1024},
        SongFile{"cover.ogg", "-i clicks.wav -i cover.png -map 1 -map 0", true},
        SongFile{"song.m4a", "-i clicks.wav", true},
        SongFile{"cover.m4a",
                 "-i clicks.wav -i cover.png -map 0 -map 1 -c:v copy -disposition:v attached_pic",
                 true},
        SongFile{"lossless.m4a", "-i clicks.wav -c:a alac", true},
        // Its times are milliseconds.
        SongFile{"song.webm", "-i clicks.wav", true, 48},
        SongFile{"film.mp4", "-f lavfi -i testsrc=s=64x64:r=25:d=13 -i clicks.wav", true}),
    [](const auto& test) {
      std::string name = test.param.name;
      name[name.find('.')] = '_';
      return name;
    });

#ifdef DANCE_HAVE_FFMPEG

std::string error_of(const std::string& file) {
  const auto audio = AudioFile::open(file);
  return audio ? "no error" : audio.error().what;
}

TEST_F(AudioFormats, AFileWithoutSoundIsNamedWithItsCure) {
  testing::internal::CaptureStderr();
  for (const char* name : {"silent.ogg", "silent.mp4"}) {
    const std::string film = make("-f lavfi -i testsrc=s=64x64:r=5:d=1", name);
    EXPECT_EQ(error_of(film), film + ": no sound in it; name a file of music");
  }
  const std::string picture = make("-f lavfi -i testsrc=s=64x64 -frames:v 1", "cover.png");
  EXPECT_EQ(error_of(picture).find(picture + ": no music that can be read"), 0u);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(AudioFormats, ADamagedFileIsNotAdvisedToBecomeWhatItIs) {
  write_bytes(path("noise.ogg"), "OggS" + std::string(3000, '\x5a'));
  const std::string error = error_of(path("noise.ogg"));
  EXPECT_EQ(error.find(path("noise.ogg") + ": "), 0u) << error;
  EXPECT_NE(error.find("copy it again"), std::string::npos) << error;
  EXPECT_EQ(error.find("to .ogg"), std::string::npos) << error;
}

TEST_F(AudioFormats, NoFileLeadsToAnother) {
  const std::string song = make("-i clicks.wav", "song.m4a");
  const std::string url = "file:" + song;
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"list.m3u8",
            "#EXTM3U\n#EXT-X-TARGETDURATION:13\n#EXTINF:13,\n" + url + "\n#EXT-X-ENDLIST\n"},
           {"list.ffconcat", "ffconcat version 1.0\nfile song.m4a\n"},
           {"list.sdp", "v=0\nc=IN IP4 127.0.0.1\nm=audio 5004 RTP/AVP 0\n"},
           {"list.mpd",
            "<?xml version=\"1.0\"?>\n<MPD xmlns=\"urn:mpeg:dash:schema:mpd:2011\">"
            "<Period><BaseURL>" +
                url + "</BaseURL></Period></MPD>\n"}}) {
    write_bytes(path(name), text);
    EXPECT_EQ(error_of(path(name)).find(path(name) + ": no "), 0u) << error_of(path(name));
  }
}

TEST_F(AudioFormats, ATruncatedSongEndsOrSaysSo) {
  const std::string whole = bytes_of(make("-i clicks.wav -movflags +faststart", "song.m4a"));
  write_bytes(path("half.m4a"), whole.substr(0, whole.size() * 3 / 4));
  auto file = AudioFile::open(path("half.m4a"));
  if (!file) {
    EXPECT_NE(file.error().what.find("copy it again"), std::string::npos) << file.error().what;
    return;
  }
  std::vector<float> samples(static_cast<std::size_t>(kSong_s * kSongRate_hz) + 4096);
  const auto read = file->read(samples);
  EXPECT_LE(read.value_or(0), static_cast<std::size_t>(kSong_s * kSongRate_hz));
}

// Packets in the middle that cannot be decoded: what comes after them stays where it was.
TEST_F(AudioFormats, ADamagedMiddleDoesNotMoveTheRest) {
  std::string bytes = bytes_of(make("-i clicks.wav -b:a 128k", "song.webm"));
  for (std::size_t i = bytes.size() * 4 / 10; i < bytes.size() / 2; ++i)
    bytes[i] = static_cast<char>(i * 89);
  write_bytes(path("hurt.webm"), bytes);
  auto file = AudioFile::open(path("hurt.webm"));
  ASSERT_TRUE(file) << file.error().what;
  const std::vector<float> samples = samples_of(*file);
  for (const double click_s : song_clicks_s()) {
    if (click_s > 0.35 * kSong_s && click_s < 0.8 * kSong_s) continue;
    auto at = static_cast<std::size_t>((click_s - 0.1) * file->rate_hz());
    while (at < samples.size() && std::abs(samples[at]) < 0.3f) ++at;
    EXPECT_NEAR(static_cast<double>(at) / file->rate_hz(), click_s, kClose_s);
  }
}

// Every file is opened and read to its end, in little time and without a word on the terminal.
TEST_F(AudioFormats, DamageIsSurvivedInBoundedTime) {
  write_wav(path("short.wav"), click_track(std::vector<double>{0.1, 0.3}, 0.4, 8000), 1, 8000);
  std::mt19937 random(20);
  std::vector<float> samples(4096);
  int played = 0, refused = 0;
  double slowest_s = 0.0;
  testing::internal::CaptureStderr();
  const auto try_file = [&](const std::string& file) {
    const auto begin = std::chrono::steady_clock::now();
    auto audio = AudioFile::open(file);
    if (audio) {
      ++played;
      std::int64_t total = 0;
      for (auto read = audio->read(samples); read && *read > 0; read = audio->read(samples))
        total += static_cast<std::int64_t>(*read);
      EXPECT_LE(total, audio->length_frames());
      static_cast<void>(audio->seek(audio->length_frames() / 2));
      static_cast<void>(audio->read(samples));
    } else {
      ++refused;
      EXPECT_EQ(audio.error().what.find(file + ": "), 0u) << audio.error().what;
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    slowest_s = std::max(slowest_s, took.count());
  };
  for (const auto& [name, arguments] : std::vector<std::pair<std::string, std::string>>{
           {"short.m4a", "-i short.wav"},
           {"short.webm", "-i short.wav -b:a 16k"},
           {"short.ogg",
            "-f lavfi -i color=red:s=16x16:r=1:d=1 -i short.wav -map 0 -map 1 "
            "-frames:v 1"}}) {
    const std::string whole = bytes_of(make(arguments, name));
    const std::string file = path("hurt" + fs::path(name).extension().string());
    for (std::size_t i = 0; i < 60; ++i) {
      write_bytes(file, whole.substr(0, whole.size() * i / 60));
      try_file(file);
    }
    for (int i = 0; i < 120; ++i) {
      std::string bytes = whole;
      for (int flips = 0; flips <= i % 4; ++flips)
        bytes[random() % bytes.size()] ^= static_cast<char>(1u << random() % 8);
      write_bytes(file, bytes);
      try_file(file);
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(played, 50);
  EXPECT_GT(refused, 50);
  EXPECT_LT(slowest_s, 10.0);
}

#endif

}  // namespace
}  // namespace dance

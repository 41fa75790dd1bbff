// Decodes the sound of an exported video, and compares it with the score of its song and with the
// times of its pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "formats/media/media_module.h"
#include "tests/test_folder.h"
#include "tests/viewer/replay/sound_recording.h"
#include "viewer/replay/export/replay_export.h"
#include "viewer/replay/export/video_file.h"

namespace dance {
namespace {

constexpr double kVideoSound_hz = SoundTrack::kSoundRate_hz;
constexpr double kVideo_hz = 25.0;
constexpr double kVideoFrom_s = 1.3;
constexpr double kVideo_s = 6.0;

// Returns the beats of the song in the range, in seconds of the video.
std::vector<double> beats_of(const RoomSong& song) {
  BandSet set;
  EXPECT_TRUE(set.set(song));
  const double begin_s = (SoundRecording::at(kVideoFrom_s) - song.start_time).as_seconds();
  std::vector<double> beats;
  for (double s = begin_s; s < begin_s + kVideo_s;) {
    s = set.next_beat(s).song_s;
    beats.push_back(s - begin_s);
  }
  return beats;
}

// Adds left and right.
std::vector<float> mono_of(std::span<const float> stereo) {
  std::vector<float> mono(stereo.size() / 2);
  for (std::size_t i = 0; i < mono.size(); ++i) mono[i] = stereo[2 * i] + stereo[2 * i + 1];
  return mono;
}

Result<std::vector<float>> decoded_sound(const std::string& path) {
  DANCE_TRY(const MediaModule* const module, media_module());
  DANCE_TRY(auto decoder, module->open_sound(path));
  EXPECT_EQ(decoder->format().rate_hz, SoundTrack::kSoundRate_hz);
  EXPECT_EQ(decoder->format().channels, 2);
  std::vector<float> all, block(9600);
  for (;;) {
    DANCE_TRY(const std::size_t frames, decoder->read(block));
    if (frames == 0) return all;
    all.insert(all.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(2 * frames));
  }
}

// Returns by how many frames `heard` is later than `score` around a moment: the lag of their best
// agreement.
int lag_at(const std::vector<float>& heard, const std::vector<float>& score, double moment_s) {
  constexpr int kMost_frames = 480;
  const auto begin = static_cast<std::ptrdiff_t>((moment_s - 0.02) * kVideoSound_hz);
  const auto end = static_cast<std::ptrdiff_t>((moment_s + 0.1) * kVideoSound_hz);
  double best = -1.0;
  int best_lag = kMost_frames;
  for (int lag = -kMost_frames; lag <= kMost_frames; ++lag) {
    double product = 0.0, energy = 1e-12;
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const auto sample = static_cast<double>(heard[static_cast<std::size_t>(i + lag)]);
      product += sample * static_cast<double>(score[static_cast<std::size_t>(i)]);
      energy += sample * sample;
    }
    const double likeness = product / std::sqrt(energy);
    if (likeness > best) {
      best = likeness;
      best_lag = lag;
    }
  }
  return best_lag;
}

class VideoSoundTest : public ::testing::TestWithParam<const char*> {
 protected:
  VideoSoundTest() {
    SoundRecording recording(10.0);
    recording.add_song(0.0, 10.0, song_);
    wish_.log = folder_.path("night.lcm");
    wish_.index = recording.write(wish_.log);
    wish_.from = SoundRecording::at(kVideoFrom_s);
    wish_.to = SoundRecording::at(kVideoFrom_s + kVideo_s);
    wish_.hz = kVideo_hz;
    wish_.kind = ExportKind::kVideo;
    beats_ = beats_of(song_);
  }

  // Skips only formats that this build cannot write: other errors of an export are failures.
  void SetUp() override {
    const std::string listed = std::string(GetParam()).substr(1) + " (";  // as in "mp4 (libx264)"
    const std::string formats = video_formats_here();
    if (formats.find(listed) == std::string::npos) GTEST_SKIP() << formats;
  }

  // A picture is white if a beat lies in its time, else black.
  Result<std::string> write_video(const std::string& name) {
    wish_.path = folder_.path(name);
    double moment_s = 0.0;
    const auto paint = [&](SceneState&, Duration passed) -> Result<Picture> {
      moment_s += passed.as_seconds();
      const bool is_beat = std::any_of(beats_.begin(), beats_.end(), [&](double beat_s) {
        return beat_s >= moment_s - 1e-6 && beat_s < moment_s + 1.0 / kVideo_hz - 1e-6;
      });
      Picture picture;
      picture.width_px = 64;
      picture.height_px = 48;
      picture.rgb.assign(std::size_t{3} * 64 * 48, is_beat ? 255 : 0);
      return picture;
    };
    DANCE_TRY(auto work, ReplayExport::begin(wish_, paint));
    for (;;) {
      DANCE_TRY(const bool is_done, work->step());
      if (is_done) return work->outcome();
    }
  }

  // Returns the times of the white pictures.
  std::vector<double> flashes() const {
    std::vector<double> times;
    const auto module = media_module();
    EXPECT_TRUE(module);
    auto video = (*module)->open_video(wish_.path);
    EXPECT_TRUE(video) << video.error().what;
    std::vector<std::uint8_t> bgr(std::size_t{3} * 64 * 48);
    while ((*video)->step()) {
      EXPECT_TRUE((*video)->read(bgr));
      const auto time = (*video)->time_s();
      EXPECT_TRUE(time);
      if (bgr[bgr.size() / 2] > 128 && time) times.push_back(*time);
    }
    return times;
  }

  TestFolder folder_{"video-sound"};
  RoomSong song_ = room_song(BandStyle::kSalsa, 9, -5.0);
  std::vector<double> beats_;
  ExportWish wish_;
};

TEST_P(VideoSoundTest, TheBandIsInTimeWithTheScoreAndThePictures) {
  const auto outcome = write_video(std::string("x") + GetParam());
  ASSERT_TRUE(outcome) << outcome.error().what;
  if (outcome->find("no sound encoder") != std::string::npos) GTEST_SKIP() << *outcome;
  EXPECT_NE(outcome->find("sound: house band (salsa), "), std::string::npos) << *outcome;
  const auto sound = decoded_sound(wish_.path);
  ASSERT_TRUE(sound) << sound.error().what;
  EXPECT_NEAR(static_cast<double>(sound->size() / 2) / kVideoSound_hz, kVideo_s, 0.025);
  for (const float sample : *sound) ASSERT_LE(std::abs(sample), 1.0f);

  const std::vector<float> heard = mono_of(*sound);
  const std::vector<float> score = mono_of(score_sound(song_, kVideoFrom_s, kVideo_s));
  const std::vector<double> white = flashes();
  ASSERT_GT(beats_.size(), 10u);
  std::size_t compared = 0;
  for (const double beat_s : beats_) {
    if (beat_s < 0.1 || beat_s > kVideo_s - 0.2) continue;
    ++compared;
    EXPECT_LE(std::abs(lag_at(heard, score, beat_s)), 48) << "a millisecond, at " << beat_s;
    const bool is_shown = std::any_of(white.begin(), white.end(), [&](double shown_s) {
      return std::abs(shown_s - beat_s) <= 1.0 / kVideo_hz;
    });
    EXPECT_TRUE(is_shown) << beat_s;
  }
  EXPECT_GT(compared, 10u);
  EXPECT_LE(white.size(), beats_.size());
}

TEST_P(VideoSoundTest, ASilentVideoHasNoSound) {
  wish_.is_silent = true;
  const auto outcome = write_video(std::string("silent") + GetParam());
  ASSERT_TRUE(outcome) << outcome.error().what;
  EXPECT_EQ(outcome->find("sound"), std::string::npos) << *outcome;
  EXPECT_FALSE(decoded_sound(wish_.path));
}

INSTANTIATE_TEST_SUITE_P(Formats, VideoSoundTest, ::testing::Values(".mp4", ".webm", ".mkv"),
                         [](const auto& each) { return std::string(each.param).substr(1); });

}  // namespace
}  // namespace dance

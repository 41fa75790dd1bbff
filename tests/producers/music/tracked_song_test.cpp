#include "producers/music/tracked_song.h"

#include <gtest/gtest.h>

#include "tests/producers/music/wav_file.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

// A file of this test's own that goes with it.
class TrackedSongTest : public testing::Test {
 protected:
  AudioFile written(const std::vector<float>& samples) {
    write_wav(path_, samples, 1, kTrackedRate_hz);
    return AudioFile::open(path_).value();
  }

  static constexpr int kTrackedRate_hz = 22050;
  TestFolder folder_{"tracked-song"};
  std::string path_ = folder_.path("song.wav");
};

TEST_F(TrackedSongTest, HasTheBeatsOfItsClicksFromItsFirstSecondOn) {
  std::vector<double> clicks_s;
  for (int i = 0; i < 24; ++i) clicks_s.push_back(0.4 + 0.5 * i);
  AudioFile file = written(click_track(clicks_s, 12.5, kTrackedRate_hz));
  const auto tracked = track_song(file);
  ASSERT_TRUE(tracked) << tracked.error().what;
  EXPECT_EQ(file.at_frame(), 0) << "the file is where it was";
  EXPECT_EQ(tracked->grid.beats_per_bar(), 0);
  EXPECT_GT(tracked->confidence, 0.2f);
  EXPECT_LE(tracked->confidence, 1.0f);
  double worst_s = 0.0;
  for (const double click_s : clicks_s) {
    const double beat = tracked->grid.beat_at(click_s);
    const double off_s = std::abs(tracked->grid.time_of(std::round(beat)) - click_s);
    if (click_s > 5.0) worst_s = std::max(worst_s, off_s);
    EXPECT_LT(off_s, 0.12) << click_s << ": before the tracker is sure, too";
  }
  EXPECT_LT(worst_s, 0.030);
}

TEST_F(TrackedSongTest, SilenceHasNone) {
  AudioFile file = written(std::vector<float>(3 * kTrackedRate_hz, 0.0f));
  const auto tracked = track_song(file);
  ASSERT_FALSE(tracked);
  EXPECT_NE(tracked.error().what.find("no steady beat"), std::string::npos);
}

TEST_F(TrackedSongTest, IsTheSameInEveryHouse) {
  std::vector<double> clicks_s;
  for (int i = 0; i < 16; ++i) clicks_s.push_back(0.2 + 0.47 * i);
  AudioFile file = written(click_track(clicks_s, 8.0, kTrackedRate_hz));
  const auto one = track_song(file), other = track_song(file);
  ASSERT_TRUE(one && other);
  ASSERT_EQ(one->grid.size(), other->grid.size());
  for (double beat = 0.0; beat <= one->grid.last_beat(); ++beat)
    EXPECT_EQ(one->grid.time_of(beat), other->grid.time_of(beat));
}

}  // namespace
}  // namespace dance

// The sound of the house band: on the beat, bounded, and the same whatever was read before.
#include "producers/music/band/band_audio.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dance {
namespace {

std::shared_ptr<const BandScore> score_of(const BandSong& song) {
  return std::make_shared<const BandScore>(BandScore::make(song));
}

std::unique_ptr<BandAudio> own_audio(std::shared_ptr<const BandScore> score) {
  auto audio = BandAudio::make(std::move(score), {});
  EXPECT_TRUE(audio);
  return audio ? std::move(*audio) : nullptr;
}

std::vector<float> read(BandAudio& audio, std::int64_t frame, std::size_t frames) {
  std::vector<float> samples(2 * frames);
  audio.read_stereo(frame, samples);
  return samples;
}

double energy(const std::vector<float>& samples) {
  double sum = 0.0;
  for (const float s : samples) sum += s * s;
  return sum;
}

TEST(BandAudio, RendersTheSameAfterAJumpAsInARow) {
  const auto score = score_of(band_song(BandStyle::kSalsa, 5, 180));
  const auto in_a_row = own_audio(score);
  const auto after_jump = own_audio(score);
  const std::int64_t begin = score->sections()[2].begin_frame;
  const auto frames = static_cast<std::size_t>(score->sections()[3].begin_frame + 60000 - begin);
  std::vector<float> all = read(*in_a_row, begin, frames);
  EXPECT_EQ(read(*after_jump, begin, frames), all);
  // Reads from the middle of a section, in odd pieces, and back again.
  const auto late = own_audio(score);
  const std::int64_t middle = begin + 50021;
  std::vector<float> pieces;
  for (std::size_t at = 50021; at < frames; at += 1000) {
    const auto piece = read(*late, begin + static_cast<std::int64_t>(at),
                            std::min<std::size_t>(1000, frames - at));
    pieces.insert(pieces.end(), piece.begin(), piece.end());
  }
  EXPECT_EQ(pieces, std::vector<float>(all.begin() + 2 * (middle - begin), all.end()));
  EXPECT_EQ(read(*late, begin, 1000), std::vector<float>(all.begin(), all.begin() + 2000));
}

TEST(BandAudio, PreparesInSmallStepsTheFramesThatAreReadLater) {
  const auto score = score_of(band_song(BandStyle::kSalsa, 5, 180));
  const auto audio = own_audio(score);
  const std::int64_t frame = score->sections()[4].begin_frame + 1000;
  int steps = 0;
  while (!audio->prepare(frame, 4800) && steps < 1000) ++steps;
  EXPECT_GT(steps, 10);
  EXPECT_LT(steps, 200);
  const auto other = own_audio(score);
  EXPECT_EQ(read(*audio, frame - 100, 100), read(*other, frame - 100, 100));
}

TEST(BandAudio, KeepsTheSoundBeforeATempoChange) {
  const BandSong song = band_song(BandStyle::kSalsa, 5, 180);
  BandSong changed = song;
  ASSERT_TRUE(changed.tempi.try_push({6, 15000}));
  const auto score = score_of(song);
  const auto playing = own_audio(score);
  const auto other = own_audio(score_of(changed));
  const std::int64_t change = score->bar_begin_frame(6);
  const auto frames = static_cast<std::size_t>(change - 20000);
  EXPECT_EQ(read(*playing, 20000, frames), read(*other, 20000, frames));
  playing->set_score(score_of(changed));
  EXPECT_EQ(read(*playing, change - 500, 300000), read(*other, change - 500, 300000));
}

TEST(BandAudio, IsSilentOutsideTheSong) {
  const auto score = score_of(band_song(BandStyle::kSalsa, 5, 180));
  const auto audio = own_audio(score);
  EXPECT_EQ(energy(read(*audio, -5000, 5000)), 0.0);
  EXPECT_GT(energy(read(*audio, -5000, 10000)), 0.0);
  EXPECT_EQ(energy(read(*audio, score->length_frames(), 5000)), 0.0);
  EXPECT_TRUE(audio->prepare(-1, 64));
  EXPECT_TRUE(audio->prepare(score->length_frames(), 64));
}

}  // namespace
}  // namespace dance

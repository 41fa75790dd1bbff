#include "producers/music/room/band_source.h"

#include <gtest/gtest.h>

#include <vector>

namespace dance {
namespace {

std::shared_ptr<BandSet> set_of(std::uint32_t seed) {
  RoomSong song;
  song.seed = seed;
  song.playing = true;
  song.tempo_centi_bpm[0] = 100 * usual_tempo_bpm(BandStyle::kSalsa);
  auto set = std::make_shared<BandSet>();
  EXPECT_TRUE(set->set(song));
  return set;
}

std::vector<float> read(BandSource& source, std::int64_t frame, std::size_t frames) {
  std::vector<float> stereo(2 * frames, 1.0f);
  EXPECT_TRUE(source.read(frame, stereo));
  return stereo;
}

TEST(BandSource, RendersTheSameSoundForALateJoiner) {
  auto one = BandSource::make(set_of(9), {}), other = BandSource::make(set_of(9), {});
  ASSERT_TRUE(one && other);
  // Reads from one song into the next.
  const auto end = set_of(9)->part_at(0).end_frame;
  for (std::int64_t frame = end - 3 * 4800; frame < end + 3 * 4800; frame += 4800) {
    const auto sound = read(**one, frame, 4800);
    if (frame < end) continue;
    EXPECT_EQ(sound, read(**other, frame, 4800)) << frame - end;
  }
}

TEST(BandSource, IsSilentBeforeTheFirstBarAndWithoutASong) {
  auto source = BandSource::make(set_of(9), {});
  ASSERT_TRUE(source);
  EXPECT_EQ(read(**source, -48000, 480), std::vector<float>(960));
  auto none = BandSource::make(std::make_shared<BandSet>(), {});
  ASSERT_TRUE(none);
  EXPECT_EQ(read(**none, 0, 480), std::vector<float>(960));
}

TEST(BandSource, PreparesTheBeginOfTheNextSong) {
  const auto set = set_of(9);
  auto source = BandSource::make(set, {});
  ASSERT_TRUE(source);
  const std::int64_t end = set->part_at(0).end_frame;
  for (int turn = 0; turn < 1500; ++turn) (*source)->prepare(end - 4800);
  auto fresh = BandSource::make(set_of(9), {});
  ASSERT_TRUE(fresh);
  EXPECT_EQ(read(**source, end, 4800), read(**fresh, end, 4800));
}

}  // namespace
}  // namespace dance

// Scores of the house band: the same on every machine. A change of tempo changes only the bars
// after it.
#include "producers/music/band/band_score.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>
#include <string>

#include "core/base/fnv1a.h"

namespace dance {
namespace {

std::vector<BandStyle> all_styles() {
  std::vector<BandStyle> styles;
  for (int i = 0; i < kBandStyles; ++i) styles.push_back(static_cast<BandStyle>(i));
  return styles;
}

BandSong usual_song(BandStyle style, std::uint32_t seed = 1) {
  return band_song(style, seed, usual_tempo_bpm(style));
}

std::uint64_t hash_of(const BandScore& score) {
  std::uint64_t hash = kFnvBegin;
  const auto add = [&hash](std::int64_t value) { hash = fnv1a(std::to_string(value) + ' ', hash); };
  for (const BandSection& section : score.sections())
    for (const BandNote& note : section.notes) {
      add(note.begin_frame);
      add(note.end_frame);
      add(static_cast<int>(note.voice));
      add(note.key);
      add(note.velocity);
    }
  return hash;
}

TEST(BandSong, IsRefusedWithWrongTempiOrBars) {
  BandSong song = usual_song(BandStyle::kSalsa);
  EXPECT_TRUE(is_valid(song));
  song.tempi[0].centi_bpm = 1;
  EXPECT_FALSE(is_valid(song));
  song.tempi[0] = {1, 18000};
  EXPECT_FALSE(is_valid(song));
  song.tempi[0] = {0, 18000};
  ASSERT_TRUE(song.tempi.try_push({0, 18000}));
  EXPECT_FALSE(is_valid(song));
  song.tempi[1] = {kMostBandBars, 18000};
  EXPECT_FALSE(is_valid(song));
  song.tempi[1] = {8, 18000};
  EXPECT_TRUE(is_valid(song));
  song.style = static_cast<BandStyle>(kBandStyles);
  EXPECT_FALSE(is_valid(song));
  EXPECT_FALSE(is_valid(BandSong{}));
}

TEST(BandSong, FindsEachStyleByItsName) {
  for (const BandStyle style : all_styles()) EXPECT_EQ(band_style_of(name_of(style)), style);
  EXPECT_FALSE(band_style_of("polka"));
}

TEST(BandScore, HasAllNotesAndBeatsOnBlocks) {
  for (const BandStyle style : all_styles()) {
    const BandScore score = BandScore::make(usual_song(style));
    EXPECT_EQ(score.length_frames() % kBandBlock_frames, 0);
    for (const BandSection& section : score.sections()) {
      EXPECT_LE(section.bars, BandScore::kSection_bars);
      EXPECT_GE(section.end_frame - section.begin_frame, BandScore::kTail_frames);
      for (const BandNote& note : section.notes) {
        ASSERT_EQ(note.begin_frame % kBandBlock_frames, 0);
        ASSERT_EQ(note.end_frame % kBandBlock_frames, 0);
      }
    }
    for (int bar = 0; bar < score.bars(); ++bar) {
      const double beat = bar * beats_per_bar(style);
      EXPECT_DOUBLE_EQ(score.grid().time_of(beat) * kBandRate_hz,
                       static_cast<double>(score.bar_begin_frame(bar)));
    }
    EXPECT_EQ(score.grid().beats_per_bar(), beats_per_bar(style));
  }
}

TEST(BandScore, FindsTheSameBarsWithoutItsNotes) {
  for (const BandStyle style : all_styles()) {
    BandSong song = usual_song(style, 9);
    ASSERT_TRUE(song.tempi.try_push({30, 80 * usual_tempo_bpm(style)}));
    const BandScore score = BandScore::make(song);
    const std::vector<std::int64_t> begins = BandScore::bar_begins(song);
    ASSERT_EQ(begins.size(), static_cast<std::size_t>(score.bars()) + 1);
    for (int bar = 0; bar <= score.bars(); ++bar)
      EXPECT_EQ(begins[static_cast<std::size_t>(bar)], score.bar_begin_frame(bar));
  }
}

TEST(BandScore, EndsEachNoteInItsSectionBeforeItsKeyIsStruckAgain) {
  for (const BandStyle style : all_styles())
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
      const BandScore score = BandScore::make(usual_song(style, seed));
      for (const BandSection& section : score.sections()) {
        std::map<std::pair<BandVoice, int>, std::int64_t> ends;
        for (const BandNote& note : section.notes) {
          ASSERT_GE(note.begin_frame, section.begin_frame);
          ASSERT_GT(note.end_frame, note.begin_frame);
          ASSERT_LE(note.end_frame, section.end_frame);
          ASSERT_GE(note.velocity, 1);
          ASSERT_LE(note.velocity, 127);
          auto& end = ends[{note.voice, note.key}];
          ASSERT_GE(note.begin_frame, end);
          end = note.end_frame;
        }
      }
    }
}

TEST(BandScore, LastsFromTwoToFiveMinutesAndEndsWithItsEnding) {
  for (const BandStyle style : all_styles())
    for (std::uint32_t seed = 0; seed < 5; ++seed) {
      const BandScore score = BandScore::make(usual_song(style, seed));
      const double length_s = static_cast<double>(score.length_frames()) / kBandRate_hz;
      EXPECT_GT(length_s, 120.0) << name_of(style);
      EXPECT_LT(length_s, 300.0) << name_of(style);
      EXPECT_EQ(score.sections().front().part, BandPartKind::kIntro);
      EXPECT_EQ(score.sections().back().part, BandPartKind::kEnding);
      EXPECT_LT(score.bars(), kMostBandBars);
    }
}

// Other machines and compilers make the same notes; a change of the music changes these numbers.
TEST(BandScore, HasTheseNotesOnEveryMachine) {
  constexpr std::array<std::uint64_t, kBandStyles> kHashes{
      8720519131726748198U, 9094945462248704947U,  13603560816862879569U, 2287449931512835015U,
      7360361286620916460U, 11280359791433314910U, 2765508298067194597U,  16157920350131939744U};
  for (const BandStyle style : all_styles())
    EXPECT_EQ(hash_of(BandScore::make(usual_song(style))), kHashes[static_cast<std::size_t>(style)])
        << name_of(style);
}

TEST(BandScore, DiffersBetweenSeeds) {
  for (const BandStyle style : all_styles()) {
    std::set<std::uint64_t> hashes;
    for (std::uint32_t seed = 0; seed < 8; ++seed)
      hashes.insert(hash_of(BandScore::make(usual_song(style, seed))));
    EXPECT_EQ(hashes.size(), 8u) << name_of(style);
  }
}

TEST(BandScore, KeepsAllBeforeTheBarOfATempoChange) {
  for (const BandStyle style : all_styles()) {
    BandSong changed = usual_song(style);
    constexpr int kBar = 30;
    ASSERT_TRUE(changed.tempi.try_push({kBar, 80 * usual_tempo_bpm(style)}));
    const BandScore before = BandScore::make(usual_song(style));
    const BandScore after = BandScore::make(changed);
    const std::int64_t frame = before.bar_begin_frame(kBar);
    EXPECT_EQ(after.bar_begin_frame(kBar), frame);
    ASSERT_EQ(after.sections().size(), before.sections().size());
    for (std::size_t i = 0; i < before.section_at(frame); ++i)
      EXPECT_EQ(after.sections()[i].notes, before.sections()[i].notes);
    EXPECT_GT(after.length_frames(), before.length_frames());
    EXPECT_NEAR(after.grid().tempo_bpm((kBar + 8) * beats_per_bar(style)),
                0.8 * usual_tempo_bpm(style), 1.0);
  }
}

TEST(BandScore, FindsBarsAndSectionsByFrame) {
  const BandScore score = BandScore::make(usual_song(BandStyle::kSalsa));
  EXPECT_EQ(score.bar_at(-1), 0);
  EXPECT_EQ(score.section_at(-1), 0u);
  for (int bar = 0; bar < score.bars(); ++bar) {
    EXPECT_EQ(score.bar_at(score.bar_begin_frame(bar)), bar);
    EXPECT_EQ(score.bar_at(score.bar_begin_frame(bar + 1) - 1), bar);
  }
  EXPECT_EQ(score.bar_at(score.length_frames()), score.bars() - 1);
  EXPECT_EQ(score.section_at(score.length_frames()), score.sections().size() - 1);
}

}  // namespace
}  // namespace dance

#include "research/beats/make/song_maker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace dance {
namespace {

TEST(SongStyle, RowsAreBarsOfLettersThatMeanSomething) {
  std::set<std::string_view> names;
  for (const SongStyle& style : song_styles()) {
    EXPECT_TRUE(names.insert(style.name).second) << style.name;
    EXPECT_LT(style.least_tempo_bpm, style.most_tempo_bpm) << style.name;
    for (const SongLayer& layer : style.layers) {
      const bool is_drum = layer.voice == SongVoice::kDrums;
      EXPECT_EQ(is_drum, !layer.drums.empty()) << style.name;
      ASSERT_FALSE(layer.rows.empty()) << style.name;
      for (const int program : layer.programs) EXPECT_TRUE(program >= 0 && program < 128);
      std::vector<std::string> rows = layer.rows;
      rows.insert(rows.end(), layer.kept_rows.begin(), layer.kept_rows.end());
      for (const std::string_view row : rows) {
        ASSERT_TRUE(row.size() == 16 || (row.size() == 33 && row[16] == '|'))
            << style.name << " " << row;
        EXPECT_EQ(row.find_first_not_of(is_drum ? ".xyzXYZop|" : ".1358ncr|"),
                  std::string_view::npos)
            << style.name << " " << row;
        for (const auto& drums : layer.drums) {
          EXPECT_TRUE(row.find_first_of("yY") == std::string_view::npos || drums[1] > 0) << row;
          EXPECT_TRUE(row.find_first_of("zZ") == std::string_view::npos || drums[2] > 0) << row;
        }
      }
    }
  }
}

TEST(SongStyle, RowsThatAreKeptBackAreNeverTaught) {
  std::size_t kept = 0;
  for (const SongStyle& style : song_styles())
    for (const SongLayer& layer : style.layers)
      for (const std::string& row : layer.kept_rows) {
        ++kept;
        EXPECT_EQ(std::count(layer.rows.begin(), layer.rows.end(), row), 0)
            << style.name << " " << row;
      }
  EXPECT_GT(kept, 80u);
}

TEST(SongMaker, ASongThatIsKeptBackHasOtherInstrumentsAndStrokes) {
  for (const SongStyle& style : song_styles()) {
    if (style.name != "cumbia" && style.name != "salsa") continue;
    const MadeSong taught = make_song(style, 30.0, 7);
    const MadeSong kept = make_song(style, 30.0, 7, SongUse::kKeptBack);
    constexpr std::size_t kBassChannel = 1;
    EXPECT_NE(taught.programs[kBassChannel], kept.programs[kBassChannel]) << style.name;
    EXPECT_NE(write_midi(taught), write_midi(kept)) << style.name;
    EXPECT_EQ(taught.tempo_bpm, kept.tempo_bpm) << style.name;
  }
}

TEST(SongMaker, EveryOtherMixedSongBorrowsFromOtherStyles) {
  const auto salsa = std::find_if(song_styles().begin(), song_styles().end(),
                                  [](const SongStyle& style) { return style.name == "salsa"; });
  ASSERT_NE(salsa, song_styles().end());
  std::set<int> own;
  for (const SongLayer& layer : salsa->layers)
    for (const auto& drums : layer.drums) own.insert(drums.begin(), drums.end());
  int with_others = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const MadeSong song = make_song(*salsa, 30.0, seed, SongUse::kMixed);
    std::size_t others = 0;
    for (const SongNote& note : song.notes) {
      if (note.channel != MadeSong::kDrumChannel) continue;
      EXPECT_GE(note.key, 35);
      EXPECT_LE(note.key, 87);
      others += own.count(note.key) == 0;
    }
    with_others += others > 40;  // more than fills and crashes
    EXPECT_GE(song.tempo_bpm, salsa->least_tempo_bpm);
    EXPECT_LE(song.tempo_bpm, salsa->most_tempo_bpm);
  }
  EXPECT_GT(with_others, 8);
  EXPECT_LT(with_others, 32);
}

TEST(SongMaker, PlaysOnTheBeatsItTells) {
  for (const SongStyle& style : song_styles())
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const MadeSong song = make_song(style, 40.0, seed);
      ASSERT_GT(song.beats_s.size(), 40u) << style.name;
      for (std::size_t i = 1; i < song.beats_s.size(); ++i) {
        const double tempo_bpm = 60.0 / (song.beats_s[i] - song.beats_s[i - 1]);
        EXPECT_GT(tempo_bpm, 0.8 * style.least_tempo_bpm) << style.name;
        EXPECT_LT(tempo_bpm, 219.0) << style.name;
      }
      ASSERT_GT(song.notes.size(), 100u) << style.name;
      std::size_t at_beats = 0;
      for (const SongNote& note : song.notes) {
        ASSERT_LT(note.start_s, song.beats_s.back() + 0.05);
        const auto next = std::lower_bound(song.beats_s.begin(), song.beats_s.end(), note.start_s);
        double away = std::abs(*std::prev(song.beats_s.end()) - note.start_s);
        if (next != song.beats_s.end()) away = *next - note.start_s;
        if (next != song.beats_s.begin()) away = std::min(away, note.start_s - *std::prev(next));
        at_beats += away < 0.03;
      }
      EXPECT_GT(at_beats, song.notes.size() / 8) << style.name << " " << seed;
    }
}

TEST(SongMaker, MakesTheSameSongOfTheSameSeed) {
  const SongStyle& style = song_styles().front();
  const auto one = write_midi(make_song(style, 30.0, 7));
  EXPECT_EQ(one, write_midi(make_song(style, 30.0, 7)));
  EXPECT_NE(one, write_midi(make_song(style, 30.0, 8)));
}

TEST(SongMaker, WritesMidiThatReadsBack) {
  MadeSong song;
  song.notes = {{1.0, 0.5, MadeSong::kDrumChannel, 36, 100}, {0.25, 2.0, 1, 40, 90}};
  const std::vector<std::uint8_t> file = write_midi(song);
  const std::vector<std::uint8_t> head{'M', 'T',  'h',  'd', 0,   0,   0,   6, 0, 0, 0,
                                       1,   0x03, 0xe8, 'M', 'T', 'r', 'k', 0, 0, 0};
  ASSERT_GT(file.size(), head.size());
  EXPECT_TRUE(std::equal(head.begin(), head.end(), file.begin()));
  // 250 ms to the bass, 750 to the drum, 500 to its end, 750 to the bass's; then the end of the
  // track.
  const std::vector<std::uint8_t> tail{0x81, 0x7a, 0x91, 40,   90,   0x85, 0x6e, 0x99,
                                       36,   100,  0x83, 0x74, 0x99, 36,   0,    0x85,
                                       0x6e, 0x91, 40,   0,    0x00, 0xff, 0x2f, 0x00};
  ASSERT_GT(file.size(), tail.size());
  EXPECT_TRUE(std::equal(tail.rbegin(), tail.rend(), file.rbegin()));
}

}  // namespace
}  // namespace dance

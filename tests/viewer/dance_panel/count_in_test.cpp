// "5 6 7 8", by the beat of the music.
#include "viewer/dance_panel/count_in.h"

#include <gtest/gtest.h>

#include <string>

namespace dance {
namespace {

std::optional<SceneMusic> music_at(double beats, int beats_per_bar = 4) {
  return SceneMusic{beats, 2.0, beats_per_bar};
}

// The numbers that are shown from one beat to another, each once; '.' where there is none.
std::string counted(CountIn& count_in, double from, double to, int beats_per_bar = 4) {
  std::string text;
  for (double beats = from; beats < to; beats += 0.05) {
    const auto count = count_in.at(music_at(beats, beats_per_bar));
    const char letter = count ? static_cast<char>('0' + count->number) : '.';
    if (text.empty() || text.back() != letter) text += letter;
  }
  return text;
}

TEST(CountIn, CountsTheNextBarAndItsOne) {
  CountIn count_in;
  count_in.ask(music_at(9.3));
  EXPECT_EQ(counted(count_in, 9.3, 20.0), ".56781.");
  EXPECT_FALSE(count_in.is_asked());
}

TEST(CountIn, TheNumbersBeginOnTheBeat) {
  CountIn count_in;
  count_in.ask(music_at(9.3));
  EXPECT_FALSE(count_in.at(music_at(11.99)));
  const auto five = count_in.at(music_at(12.01));
  ASSERT_TRUE(five);
  EXPECT_EQ(five->number, 5);
  EXPECT_NEAR(five->since, 0.01f, 1e-3f);
  EXPECT_EQ(count_in.at(music_at(15.9))->number, 8);
  const auto one = count_in.at(music_at(16.0));
  ASSERT_TRUE(one);
  EXPECT_TRUE(one->is_one);
}

TEST(CountIn, KnowsWaltzesAndMusicBeforeItsFirstBar) {
  CountIn waltz;
  waltz.ask(music_at(1.0, 3));
  EXPECT_EQ(counted(waltz, 1.0, 9.0, 3), ".4561.");
  CountIn early;
  early.ask(music_at(-2.5));
  EXPECT_EQ(counted(early, -2.5, 7.0), ".56781.");
}

TEST(CountIn, CountsNothingWithoutMusicOrItsBar) {
  CountIn count_in;
  count_in.ask(std::nullopt);
  EXPECT_FALSE(count_in.is_asked());
  count_in.ask(music_at(9.0, 0));
  EXPECT_FALSE(count_in.is_asked());
  count_in.ask(music_at(9.0));
  EXPECT_TRUE(count_in.is_asked());
  EXPECT_FALSE(count_in.at(std::nullopt)) << "the music has ended";
  EXPECT_FALSE(count_in.is_asked());
}

TEST(CountIn, EndsWhereTheMusicJumps) {
  for (const double to : {2.0, 40.0}) {
    CountIn count_in;
    count_in.ask(music_at(9.0));
    EXPECT_FALSE(count_in.at(music_at(to))) << to;
    EXPECT_FALSE(count_in.is_asked()) << to;
  }
  CountIn slewed;
  slewed.ask(music_at(9.0));
  (void)slewed.at(music_at(8.9));
  EXPECT_TRUE(slewed.is_asked()) << "a clock that takes a little back";
}

}  // namespace
}  // namespace dance

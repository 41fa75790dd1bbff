#include "producers/music/beats_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/test_folder.h"

namespace dance {
namespace {

std::string parse_error(std::string_view text) {
  const auto grid = parse_beats(text);
  return grid ? "no error" : grid.error().what;
}

TEST(BeatsFile, ReadsSecondsAndPositions) {
  const auto grid = parse_beats("# a song\n0.5\t1\n0.9\t2\r\n\n1.3 3\n1.7\t4\n2.1\t1");
  ASSERT_TRUE(grid) << grid.error().what;
  EXPECT_EQ(grid->size(), 5u);
  EXPECT_EQ(grid->beats_per_bar(), 4);
  EXPECT_NEAR(grid->time_of(4.0), 2.1, 1e-12);
}

TEST(BeatsFile, APositionMayBeMissing) {
  const auto grid = parse_beats("0.5\n0.9\n1.3\n");
  ASSERT_TRUE(grid) << grid.error().what;
  EXPECT_EQ(grid->beats_per_bar(), 0);
}

TEST(BeatsFile, NamesTheLineThatIsWrong) {
  EXPECT_EQ(parse_error("0.5\t1\nsoon\t2\n").find("line 2: no time: 'soon"), 0u);
  EXPECT_EQ(parse_error("0.5\t1\n# here\n0.9\ttwo\n").find("line 3: no position"), 0u);
  EXPECT_EQ(parse_error("0.5\t1\n0.9\t2 3\n").find("line 2: no position"), 0u);
  EXPECT_NE(parse_error("1.5\t1\n0.9\t2\n").find("line 2"), std::string::npos);
  EXPECT_NE(parse_error("1.5\t1\n\x01\x02\x7f\n").find("'   '"), std::string::npos);
  EXPECT_NE(parse_error("").find("at least two"), std::string::npos);
}

TEST(BeatsFile, IsBounded) {
  std::string text;
  for (int i = 0; i < 100001; ++i) text += std::to_string(i * 0.3) + "\n";
  EXPECT_NE(parse_error(text).find("more than 100000"), std::string::npos);
  EXPECT_NE(parse_error(std::string(5u << 20, '\n')).find("4 MiB"), std::string::npos);
}

TEST(BeatsFile, NamesTheFileAndStandsBesideTheMusic) {
  const auto missing = read_beats_file("/nowhere/song.beats");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().what, "/nowhere/song.beats: no such file");
  ASSERT_FALSE(read_beats_file("/tmp"));

  const TestFolder folder("beats-file");
  std::ofstream(folder.path("song.beats")) << "0.5\t1\n1.0\t2\n";
  const auto grid = read_beats_file(folder.path("song.beats"));
  ASSERT_TRUE(grid) << grid.error().what;
  EXPECT_NEAR(grid->tempo_bpm(0), 120.0, 1e-9);

  EXPECT_EQ(beats_path_beside("a.b/song.ogg"), "a.b/song.beats");
  EXPECT_EQ(beats_path_beside("a.b/song"), "a.b/song.beats");
  EXPECT_EQ(beats_path_beside(".hidden"), ".hidden.beats");
}

}  // namespace
}  // namespace dance

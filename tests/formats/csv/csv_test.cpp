#include <gtest/gtest.h>

#include <sstream>

#include "consumers/text/csv_consumer.h"
#include "formats/csv/csv_reader.h"
#include "tests/formats/recording/recorded_night.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

// As dance listen --to csv and dance convert write it.
std::string table_of(const Recording& night) {
  const TestFolder folder("csv");
  const std::string path = folder.path("night.csv");
  {
    auto output = OutputFile::open(path);
    EXPECT_TRUE(output.has_value());
    struct Writer : RecordingSink {
      explicit Writer(std::shared_ptr<OutputFile> output) : table(std::move(output), 0.0) {}
      void on_skeleton(const GuestId& guest, const Skeleton& skeleton, std::int64_t us) override {
        table.on_skeleton(guest, skeleton, MonoTime::from_us(us));
      }
      void on_pose(const GuestId& guest, const Pose& pose, std::int64_t us) override {
        table.on_pose(guest, pose, MonoTime::from_us(us));
      }
      void on_hands(const GuestId&, const Hands&, std::int64_t) override {}
      void on_beat(const Beat&, std::int64_t) override {}
      CsvConsumer table;
    } writer(std::move(*output));
    night.play_into(writer);
    EXPECT_TRUE(writer.table.finish().has_value());
  }
  return text_of(path);
}

struct Read {
  Recording night;
  CsvReader::Counters counters;
  std::uint64_t too_long = 0;
  std::string error;
};

Read read(std::string_view table) {
  Read result;
  auto reader = CsvReader::over(table);
  if (!reader) {
    result.error = reader.error().what;
    return result;
  }
  if (const auto done = reader->read_into(result.night); !done) result.error = done.error().what;
  result.counters = reader->counters();
  result.too_long = reader->too_long_lines();
  return result;
}

std::vector<std::vector<std::string>> cells_of(const std::string& table) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::size_t begin = 0;
    for (std::size_t comma; (comma = line.find(',', begin)) != std::string::npos; begin = comma + 1)
      rows.back().push_back(line.substr(begin, comma - begin));
    rows.back().push_back(line.substr(begin));
  }
  return rows;
}

TEST(CsvReader, RecoversPosesAndTheSkeletonFromPlaces) {
  const Recording night = recorded_night(60);
  const Read again = read(table_of(night));
  EXPECT_EQ(again.error, "");
  EXPECT_EQ(again.counters.poses, 120u);
  EXPECT_EQ(again.counters.malformed + again.counters.invalid, 0u);
  expect_same_poses(night, again.night);
  for (const RecordedGuest& guest : night.guests()) {
    ASSERT_EQ(again.night.find(guest.guest)->skeletons.size(), 1u);  // the same in every row
    const Skeleton read_back = again.night.find(guest.guest)->skeleton();
    for (std::size_t b = 0; b < kBoneCount; ++b)
      EXPECT_LT((read_back.offset_m[b] - guest.skeleton().offset_m[b]).norm(), 1e-5f);
  }
}

TEST(CsvReader, FollowsADancerWhoIsMeasuredAnew) {
  Recording night;
  Random random(9);
  for (std::uint32_t i = 0; i < 40; ++i) {
    if (i % 20 == 0)
      night.on_skeleton(kAlice, average_skeleton(i == 0 ? 1.6f : 1.7f), kNight_us + i);
    night.on_pose(kAlice, night_pose(random, i), kNight_us + i);
  }
  const Read again = read(table_of(night));
  EXPECT_EQ(again.night.find(kAlice)->skeletons.size(), 2u);
  EXPECT_EQ(again.night.find(kAlice)->skeletons[1].time_us, kNight_us + 20);
}

TEST(CsvReader, ReadsWhatASpreadsheetMakesOfATable) {
  const Recording night = recorded_night(6);
  std::vector<std::vector<std::string>> rows = cells_of(table_of(night));
  // Columns in another order and one more, quotes, a mark of the encoding, Windows' line ends.
  std::string table = "\xEF\xBB\xBF";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::reverse(rows[r].begin(), rows[r].end());
    table += r == 0 ? "remark" : "\"fine\"";
    for (const std::string& cell : rows[r]) {
      const bool is_name = r > 0 && (cell == "alice" || cell == "bob");
      table += is_name ? ",\"" + cell + "\"" : ", " + cell;
    }
    table += "\r\n";
  }
  const Read again = read(table);
  EXPECT_EQ(again.error, "");
  expect_same_poses(night, again.night);
}

// A spreadsheet saves large numbers with the digits that it shows.
std::string with_rounded(const Recording& night, std::vector<std::size_t> columns,
                         const char* text) {
  std::string table;
  auto rows = cells_of(table_of(night));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (r > 0)
      for (const std::size_t column : columns) rows[r][column] = text;
    for (std::size_t i = 0; i < rows[r].size(); ++i) table += (i > 0 ? "," : "") + rows[r][i];
    table += "\n";
  }
  return table;
}

TEST(CsvReader, UsesTheOtherColumnWhereOneIsRounded) {
  const Recording night = recorded_night(20);
  for (const char* rounded : {"1.79549E+15", "1795490000000000"}) {
    const Read again = read(with_rounded(night, {0}, rounded));
    ASSERT_EQ(again.error, "") << rounded;
    ASSERT_NE(again.night.find(kAlice), nullptr);
    const auto& poses = again.night.find(kAlice)->poses;
    const auto& as_was = night.find(kAlice)->poses;
    ASSERT_EQ(poses.size(), as_was.size());
    for (std::size_t i = 1; i < poses.size(); ++i)
      EXPECT_EQ(poses[i].time_us - poses[0].time_us,
                (as_was[i].value.capture_time - as_was[0].value.capture_time).count_ns() / 1000);
  }
  const Read captured = read(with_rounded(night, {1}, "3.256E+09"));
  ASSERT_EQ(captured.error, "");
  const auto& poses = captured.night.find(kBob)->poses;
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_EQ(poses[i].value.capture_time.since_zero_us(), poses[i].time_us);
}

TEST(CsvReader, RefusesATableWhoseTimesAreAllRounded) {
  const Read again = read(with_rounded(recorded_night(20), {0, 1}, "1.79549E+15"));
  EXPECT_NE(again.error.find("its times are rounded, as spreadsheets save them (1.79549E+15)"),
            std::string::npos)
      << again.error;
  EXPECT_EQ(again.counters.poses, 0u);
}

TEST(CsvReader, TakesAnAverageBodyWhereATableHasNoPlaces) {
  const Recording night = recorded_night(3);
  std::string table;
  for (auto& row : cells_of(table_of(night))) {
    row.resize(TableColumns::kPositions);  // as dance listen wrote until it had places
    for (std::size_t i = 0; i < row.size(); ++i) table += (i > 0 ? "," : "") + row[i];
    table += "\n";
  }
  const Read again = read(table);
  ASSERT_NE(again.night.find(kBob), nullptr) << again.error;
  EXPECT_EQ(again.night.find(kBob)->poses.size(), 3u);
  EXPECT_EQ(again.night.find(kBob)->skeleton(), average_skeleton());
}

TEST(CsvReader, NamesTheColumnThatIsMissingAndTheCure) {
  EXPECT_NE(read("a;b;c\n1;2;3\n").error.find("has no column 'guest'"), std::string::npos);
  EXPECT_NE(read("").error.find("has no column"), std::string::npos);
  std::string table = table_of(recorded_night(1));
  table.replace(table.find("leftFoot_w,"), 10, "leftFoot_q");
  EXPECT_NE(read(table).error.find("has no column 'leftFoot_w'"), std::string::npos);
  table = table_of(recorded_night(1));
  table.resize(table.find('\n') + 1);
  EXPECT_NE(read(table).error.find("has no rows"), std::string::npos);
}

TEST(CsvReader, CountsRowsThatAreNoPoseByCause) {
  const std::string table = table_of(recorded_night(4));
  std::vector<std::vector<std::string>> rows = cells_of(table);
  rows[1][8] = "here";  // hips
  rows[2][3] = "Not A Guest";
  rows[3][8] = "1e30";                       // off the stage
  rows[4][TableColumns::kPositions] = "50";  // a bone of 50 m
  rows[5].resize(20);
  rows[6][1] = "99999999999999999";  // later than any clock
  std::string damaged;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) damaged += (i > 0 ? "," : "") + row[i];
    damaged += "\n";
  }
  damaged += std::string(CsvLines::kMostLine_bytes + 1, '1') + "\n";
  const Read again = read(damaged);
  EXPECT_EQ(again.counters.malformed, 4u);
  EXPECT_EQ(again.counters.invalid, 2u);
  EXPECT_EQ(again.counters.poses, 2u);
  EXPECT_EQ(again.too_long, 1u);
}

TEST(CsvReader, SurvivesEachPrefixAndEachBitFlipped) {
  const std::string table = table_of(recorded_night(1));
  for (std::size_t size = 0; size <= table.size(); ++size)
    ASSERT_LE(read(std::string_view(table).substr(0, size)).counters.poses, 2u);
  for (std::size_t at = 0; at < table.size(); ++at) {
    std::string damaged = table;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (at % 8)));
    ASSERT_LE(read(damaged).counters.poses, 3u);
  }
}

TEST(CsvLines, ReadsAFileAsItReadsMemory) {
  const TestFolder folder("csv-lines");
  std::string text;
  Random random(4);
  for (int i = 0; i < 300; ++i)
    text += std::string(random.below(2000), 'a') + (i % 2 ? "\n" : "\r\n");
  text += std::string(200'000, 'b') + "\nlast";
  std::ofstream(folder.path("x.csv"), std::ios::binary) << text;
  CsvLines file = CsvLines::open(folder.path("x.csv")).value();
  CsvLines memory = CsvLines::over(text);
  for (;;) {
    const auto a = file.next();
    const auto b = memory.next();
    ASSERT_EQ(a, b);
    if (!a) break;
  }
  EXPECT_EQ(file.too_long(), 1u);
  EXPECT_EQ(memory.too_long(), 1u);
  EXPECT_TRUE(file.ended().has_value());
  EXPECT_FALSE(CsvLines::open(folder.path("none.csv")).has_value());
}

}  // namespace
}  // namespace dance

// However a moment of a recording is reached, its scene is the same, bit for bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>

#include "formats/replay/index_file.h"
#include "tests/test_folder.h"
#include "tests/viewer/replay/recorded_night.h"
#include "viewer/feed/stage_roster.h"
#include "viewer/replay/index_builder.h"
#include "viewer/replay/replay_feed.h"

namespace dance {
namespace {

// One way to look at a log.
struct Look {
  Look(const std::string& path, std::shared_ptr<const ReplayIndex> of)
      : board(of->clock_id, false),
        roster(board),
        feed(std::move(*ReplayFeed::open(path, of, board))) {}
  SceneState jumped(MonoTime moment) {
    feed.show(moment);
    return scene(moment);
  }
  SceneState read(MonoTime moment) {
    feed.show_from_the_beginning(moment);
    return scene(moment);
  }
  SceneState read_on(MonoTime moment) {
    feed.read_on_to(moment);
    return scene(moment);
  }
  SceneState scene(MonoTime moment) {
    SceneState shown;
    roster.update(moment, shown);
    return shown;
  }
  GuestBoard board;
  StageRoster roster;
  ReplayFeed feed;
};

std::shared_ptr<const ReplayIndex> index_of(const std::string& path) {
  auto index = build_index(path, false, {});
  EXPECT_TRUE(index) << index.error().what;
  return std::make_shared<const ReplayIndex>(std::move(*index));
}

void expect_same(const SceneGuest& a, const SceneGuest& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.opacity, b.opacity);
  EXPECT_EQ(a.sign, b.sign);
  EXPECT_EQ(a.sign_age_s, b.sign_age_s);
  EXPECT_EQ(a.skeleton, b.skeleton);
  EXPECT_EQ(a.pose.sequence, b.pose.sequence) << a.id.view();
  EXPECT_EQ(a.pose.capture_time, b.pose.capture_time);
  EXPECT_EQ(a.pose.hops, b.pose.hops);
  EXPECT_EQ(a.pose.p_WH_m, b.pose.p_WH_m);
  for (std::size_t i = 0; i < kBoneCount; ++i)
    EXPECT_EQ(a.pose.R_PB[i].coeffs(), b.pose.R_PB[i].coeffs()) << a.id.view();
  ASSERT_EQ(a.hands.has_value(), b.hands.has_value()) << a.id.view();
  if (a.hands) {
    EXPECT_EQ(a.hands->capture_time, b.hands->capture_time) << a.id.view();
    for (std::size_t i = 0; i < kFingerBoneCount; ++i)
      EXPECT_EQ(a.hands->R_PB[i].coeffs(), b.hands->R_PB[i].coeffs());
  }
  EXPECT_EQ(a.figures.arrival_hz, b.figures.arrival_hz) << a.id.view();
  EXPECT_EQ(a.figures.age_ms, b.figures.age_ms) << a.id.view();
  EXPECT_EQ(a.figures.loss_percent, b.figures.loss_percent) << a.id.view();
  ASSERT_EQ(a.figures.beat.has_value(), b.figures.beat.has_value()) << a.id.view();
  if (!a.figures.beat) return;
  EXPECT_EQ(a.figures.beat->behind_ms, b.figures.beat->behind_ms) << a.id.view();
  EXPECT_EQ(a.figures.beat->wander_ms, b.figures.beat->wander_ms) << a.id.view();
  EXPECT_EQ(a.figures.beat->delay_ms, b.figures.beat->delay_ms) << a.id.view();
  EXPECT_EQ(a.figures.beat->own_beat_count, b.figures.beat->own_beat_count);
  EXPECT_EQ(a.figures.beat->own_beats, b.figures.beat->own_beats) << a.id.view();
}

void expect_same(const SceneState& a, const SceneState& b) {
  EXPECT_EQ(a.time, b.time);
  ASSERT_EQ(a.guests.size(), b.guests.size());
  for (std::size_t i = 0; i < a.guests.size(); ++i) expect_same(a.guests[i], b.guests[i]);
  ASSERT_EQ(a.lines.size(), b.lines.size());
  for (std::size_t i = 0; i < a.lines.size(); ++i) {
    EXPECT_EQ(a.lines[i].guest, b.lines[i].guest);
    EXPECT_EQ(a.lines[i].text, b.lines[i].text);
    EXPECT_EQ(a.lines[i].written, b.lines[i].written);
  }
  ASSERT_EQ(a.music.has_value(), b.music.has_value());
  if (!a.music) return;
  EXPECT_EQ(a.music->beats, b.music->beats);
  EXPECT_EQ(a.music->beats_per_second, b.music->beats_per_second);
  EXPECT_EQ(a.music->beats_per_bar, b.music->beats_per_bar);
}

// Reads the log once from its beginning to its end, and jumps to the same moments in any order.
void expect_same_whatever_the_order(const std::string& path, int moments, std::uint32_t seed) {
  const auto index = index_of(path);
  Look jumping(path, index), reading(path, index);
  std::mt19937 random(seed);
  const double length_s = (index->end - index->begin).as_seconds();
  std::uniform_real_distribution<double> anywhere(-0.2, length_s + 0.4);
  std::uniform_real_distribution<double> near(-1.5, 2.5);
  std::vector<MonoTime> order;
  double s = 0.0;
  for (int i = 0; i < moments; ++i) {
    s = i % 3 == 0 ? anywhere(random) : s + near(random);
    order.push_back(index->begin + Duration::seconds(s));
  }
  std::vector<MonoTime> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  std::map<MonoTime, SceneState> read;
  reading.feed.show_from_the_beginning(sorted.front());
  for (const MonoTime moment : sorted) read.emplace(moment, reading.read_on(moment));
  for (const MonoTime moment : order) {
    SCOPED_TRACE(path + " at " + std::to_string((moment - index->begin).as_seconds()));
    expect_same(jumping.jumped(moment), read.at(moment));
    if (::testing::Test::HasFailure()) return;
  }
}

std::string shipped(const char* name) { return std::string(DANCE_SOURCE_DIR) + "/logs/" + name; }

TEST(ReplaySeek, OfTheShippedLogsEveryOrderGivesTheSameScene) {
  expect_same_whatever_the_order(shipped("couple.lcm"), 60, 1);
  expect_same_whatever_the_order(shipped("couple-packed.lcm"), 60, 2);
}

class RecordedNight : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    master_ = std::make_unique<TestFolder>("recorded-night-once");
    write_recorded_night(master_->path("plain.lcm"), 45.0, false);
    write_recorded_night(master_->path("packed.lcm"), 45.0, true);
  }
  static void TearDownTestSuite() { master_.reset(); }
  RecordedNight() {
    std::filesystem::copy_file(master_->path("plain.lcm"), plain_);
    std::filesystem::copy_file(master_->path("packed.lcm"), packed_);
  }
  static inline std::unique_ptr<TestFolder> master_;
  TestFolder folder_{"recorded-night"};
  std::string plain_ = folder_.path("plain.lcm"), packed_ = folder_.path("packed.lcm");
};

TEST_F(RecordedNight, WithGapsAndTwoSongsEveryOrderGivesTheSameScene) {
  expect_same_whatever_the_order(plain_, 60, 3);
  expect_same_whatever_the_order(packed_, 60, 4);
}

TEST_F(RecordedNight, PackedAndPlainShowTheSame) {
  const auto index = index_of(plain_);
  const auto packed_index = index_of(packed_);
  EXPECT_GE(index->checkpoints.size(), 3u);
  EXPECT_EQ(index->begin, packed_index->begin);
  EXPECT_EQ(index->end, packed_index->end);
  EXPECT_EQ(index->wall_ahead_us, packed_index->wall_ahead_us);
  ASSERT_EQ(index->beats.size(), packed_index->beats.size());
  for (std::size_t i = 0; i < index->beats.size(); ++i) {
    EXPECT_EQ(index->beats[i].beat, packed_index->beats[i].beat);
    EXPECT_EQ(index->beats[i].time, packed_index->beats[i].time);
  }
  EXPECT_EQ(index->gaps.size(), packed_index->gaps.size());
  Look plain(plain_, index), packed(packed_, packed_index);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(0.0, 45.0);
  for (int i = 0; i < 30; ++i) {
    const MonoTime moment = index->begin + Duration::seconds(anywhere(random));
    expect_same(plain.jumped(moment), packed.jumped(moment));
  }
}

TEST_F(RecordedNight, LinesAndSignsAreShownAtTheirTime) {
  const auto index = index_of(packed_);
  Look look(packed_, index);
  const MonoTime late = index->begin + Duration::s(44);
  const SceneState end = look.jumped(late);
  ASSERT_EQ(end.lines.size(), 11u);
  EXPECT_EQ(end.lines.back().text, "the song since 2500 \xe2\x99\xa5");
  EXPECT_EQ(end.lines.back().guest.view(), "guest-0");
  const SceneState begin = look.jumped(index->begin + Duration::ms(2000));
  ASSERT_EQ(begin.lines.size(), 1u);
  EXPECT_NEAR((begin.lines[0].written - index->begin).as_seconds(), 100.0 / 60.0, 0.001);
  EXPECT_EQ(begin.guests[0].sign, DanceSign::kHeart);
  EXPECT_NEAR(begin.guests[0].sign_age_s, 0.5f, 0.001f);
  EXPECT_EQ(look.jumped(index->begin + Duration::ms(3600)).guests[0].sign, DanceSign::kNone);
}

TEST_F(RecordedNight, TheIndexSaysWhoPausedAndWhenTheBeatsWere) {
  const auto index = index_of(packed_);
  ASSERT_EQ(index->guests.size(), 5u);
  std::size_t pauses = 0;
  for (const ReplayIndex::Gap& gap : index->gaps) {
    if (index->guests[gap.guest].id.view() != "guest-1") continue;
    ++pauses;
    EXPECT_NEAR((gap.end - gap.begin).as_seconds(), 1.0, 0.05);
  }
  EXPECT_EQ(pauses, 4u);  // one every nine seconds; the fifth does not end
  EXPECT_EQ(index->gaps.size(), pauses);
  const auto& late = *std::find_if(index->guests.begin(), index->guests.end(),
                                   [](const auto& g) { return g.id.view() == "guest-2"; });
  EXPECT_NEAR((late.first - index->begin).as_seconds(), 6.0, 0.05);
  EXPECT_NEAR((late.last - index->begin).as_seconds(), 31.0, 0.05);
  // Two songs: beats begin again, in bars of four and of three.
  std::size_t fours = 0, threes = 0;
  for (const ReplayIndex::WholeBeat& beat : index->beats)
    beat.beats_per_bar == 4 ? ++fours : ++threes;
  EXPECT_NEAR(static_cast<double>(fours), 40.0, 2.0);
  EXPECT_NEAR(static_cast<double>(threes), 40.0, 2.0);
  std::uint64_t poses = 0;
  for (const std::uint32_t part : index->density) poses += part;
  std::uint64_t of_guests = 0;
  for (const ReplayIndex::Guest& guest : index->guests) of_guests += guest.poses;
  EXPECT_EQ(poses, of_guests);
}

TEST_F(RecordedNight, AnIndexIsKeptBesideTheLogAndUsedAgain) {
  const auto first = index_of_log(packed_, false, {});
  ASSERT_TRUE(first);
  EXPECT_FALSE(first->was_kept);
  EXPECT_EQ(first->note, "");
  EXPECT_TRUE(std::filesystem::exists(packed_ + ".index"));
  const auto second = index_of_log(packed_, false, {});
  ASSERT_TRUE(second);
  EXPECT_TRUE(second->was_kept);
  EXPECT_EQ(write_index(second->index), write_index(first->index));
}

TEST_F(RecordedNight, ALogThatGoesOnOrIsCutIsLookedThroughAnew) {
  ASSERT_TRUE(index_of_log(packed_, false, {}));
  const auto bytes = std::filesystem::file_size(packed_);
  std::filesystem::resize_file(packed_, bytes / 2);
  const auto cut = index_of_log(packed_, false, {});
  ASSERT_TRUE(cut);
  EXPECT_FALSE(cut->was_kept);
  EXPECT_LT((cut->index.end - cut->index.begin).as_seconds(), 30.0);
  expect_same_whatever_the_order(packed_, 10, 6);
}

TEST_F(RecordedNight, ADamagedIndexIsMadeAnew) {
  const auto first = index_of_log(packed_, false, {});
  ASSERT_TRUE(first);
  std::FILE* file = std::fopen((packed_ + ".index").c_str(), "r+b");
  ASSERT_NE(file, nullptr);
  std::fseek(file, 200, SEEK_SET);
  std::fputc('x', file);
  std::fclose(file);
  const auto again = index_of_log(packed_, false, {});
  ASSERT_TRUE(again);
  EXPECT_FALSE(again->was_kept);
  EXPECT_EQ(write_index(again->index), write_index(first->index));
  EXPECT_TRUE(index_of_log(packed_, false, {})->was_kept);
}

TEST_F(RecordedNight, WhereTheFolderCannotBeWrittenTheIndexIsInTheCache) {
  setenv("XDG_CACHE_HOME", folder_.path("cache").c_str(), 1);
  // A folder of that name is in the way, also of the superuser.
  std::filesystem::create_directories(packed_ + ".index/in-the-way");
  const auto first = index_of_log(packed_, false, {});
  ASSERT_TRUE(first);
  EXPECT_EQ(first->note, "");
  EXPECT_TRUE(index_of_log(packed_, false, {})->was_kept);
  EXPECT_TRUE(std::filesystem::exists(folder_.path("cache") + "/dancegraph"));
  unsetenv("XDG_CACHE_HOME");
}

TEST_F(RecordedNight, ReadingIsEndedByWhoeverAsked) {
  int asked = 0;
  const auto index = build_index(packed_, false, [&](double) { return ++asked < 3; });
  ASSERT_FALSE(index);
  EXPECT_NE(index.error().what.find("ended"), std::string::npos);
}

TEST_F(RecordedNight, AStateThatIsNotSoundIsReadFromTheBeginningInstead) {
  ReplayIndex spoilt = *index_of(packed_);
  ASSERT_GT(spoilt.checkpoints.size(), 2u);
  for (auto& checkpoint : spoilt.checkpoints)
    for (std::size_t i = 0; i < checkpoint.state.size(); i += 3) checkpoint.state[i] = 0xff;
  const auto index = std::make_shared<const ReplayIndex>(spoilt);
  Look jumping(packed_, index), reading(packed_, index);
  const MonoTime moment = index->begin + Duration::s(33);
  expect_same(jumping.jumped(moment), reading.read(moment));
}

}  // namespace
}  // namespace dance

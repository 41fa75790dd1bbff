// A recorded house, looked at as late as one likes.
#include "viewer/replay/replay_feed.h"

#include <gtest/gtest.h>

#include "core/bus/encode.h"
#include "tests/test_folder.h"
#include "viewer/feed/stage_roster.h"
#include "viewer/replay/index_builder.h"

namespace dance {
namespace {

constexpr std::uint64_t kLogClock = 5;
constexpr std::int64_t kWallAhead_us = 1'700'000'000'000'000;

MonoTime logged_second(double s) { return MonoTime() + Duration::seconds(50.0 + s); }

class ReplayFeedTest : public ::testing::Test {
 protected:
  ReplayFeedTest() {
    auto log = LogWriter::create(path_);
    EXPECT_TRUE(log);
    writer_ = std::make_unique<LogWriter>(std::move(*log));
  }

  template <class Message>
  void write(double s, const Channel& channel, const Message& message) {
    MessageBuffer buffer;
    const std::size_t size = encode(message, buffer);
    const std::int64_t us = logged_second(s).since_zero_us() + kWallAhead_us;
    ASSERT_TRUE(writer_->append(us, channel.view(), {buffer.data(), size}));
  }
  static Pose pose_of(double s, double beats) {
    Pose pose;
    pose.clock_id = kLogClock;
    pose.capture_time = logged_second(s);
    pose.p_WH_m.x() = static_cast<float>(s);
    pose.music_beats = beats;
    return pose;
  }
  // Alice dances here, at two beats a second; bob is shown a tenth of a second late.
  void write_couple(double seconds) {
    for (int i = 0; i < static_cast<int>(60 * seconds); ++i) {
      const double s = i / 60.0;
      write(s, Channel::of(Signal::kPose, Where::kCapture, *GuestId::parse("alice")),
            pose_of(s, 2.0 * s));
      Pose bob = pose_of(s - 0.1, 2.0 * (s - 0.1));
      bob.stamp(Hop::kStaged, logged_second(s));
      write(s, Channel::of(Signal::kPose, Where::kStage, *GuestId::parse("bob")), bob);
    }
    ASSERT_TRUE(writer_->flush());
  }

  // The log's feed, on a board of its own.
  struct Opened {
    explicit Opened(const std::string& path) {
      auto built = build_index(path, false, {});
      if (!built) {
        failure = built.error().what;
        return;
      }
      index = std::make_shared<const ReplayIndex>(std::move(*built));
      board.clear(index->clock_id);
      auto opened = ReplayFeed::open(path, index, board);
      if (opened) feed.emplace(std::move(*opened));
    }
    GuestBoard board{0, false};
    std::shared_ptr<const ReplayIndex> index;
    std::optional<ReplayFeed> feed;
    std::string failure;
  };

  TestFolder folder_{"replay-feed"};
  std::string path_ = folder_.path("log.lcm");
  std::unique_ptr<LogWriter> writer_;
};

TEST_F(ReplayFeedTest, ShowsTheStageOfAnyMomentInTheHousesOwnTime) {
  write_couple(4.0);
  Opened log(path_);
  ASSERT_TRUE(log.feed) << log.failure;
  EXPECT_NEAR((log.index->begin - logged_second(0.0)).as_seconds(), 0.0, 1e-5);
  EXPECT_NEAR((log.index->end - logged_second(4.0)).as_seconds(), 0.0, 0.02);
  StageRoster roster(log.board);
  SceneState scene;
  for (const double s : {1.0, 3.0}) {
    log.feed->show(logged_second(s));
    roster.update(logged_second(s), scene);
    ASSERT_EQ(scene.guests.size(), 2u);
    EXPECT_NEAR(scene.guests[0].pose.p_WH_m.x(), s, 0.02);
    EXPECT_NEAR(scene.guests[1].pose.p_WH_m.x(), s - 0.1, 0.02);
    ASSERT_TRUE(scene.music);
    EXPECT_NEAR(scene.music->beats, 2.0 * s, 1e-3);
  }
  ASSERT_TRUE(scene.guests[1].figures.beat);
  EXPECT_NEAR(scene.guests[1].figures.beat->behind_ms, 100.0f, 1.0f);
  EXPECT_NEAR(scene.guests[0].figures.beat->behind_ms, 0.0f, 1.0f);
}

TEST_F(ReplayFeedTest, ShowsWhatACameraRecordedWithoutAStage) {
  for (int i = 0; i < 120; ++i) {
    Pose pose = pose_of(i / 30.0, kNoMusic);
    pose.stamp(Hop::kPublished, logged_second(i / 30.0));
    write(i / 30.0, Channel::of(Signal::kPose, Where::kCapture, *GuestId::parse("alice")), pose);
  }
  ASSERT_TRUE(writer_->flush());
  Opened log(path_);
  ASSERT_TRUE(log.feed) << log.failure;
  EXPECT_NEAR((log.index->begin - logged_second(0.0)).as_seconds(), 0.0, 1e-5);
  log.feed->show(logged_second(2.0));
  StageRoster roster(log.board);
  SceneState scene;
  roster.update(logged_second(2.0), scene);
  ASSERT_EQ(scene.guests.size(), 1u);
  EXPECT_NEAR(scene.guests[0].pose.p_WH_m.x(), 2.0, 0.04);
}

TEST_F(ReplayFeedTest, AtTheBeginningAgainNobodyIsLeftOfTheEnd) {
  write_couple(4.0);
  Opened log(path_);
  ASSERT_TRUE(log.feed) << log.failure;
  StageRoster roster(log.board);
  SceneState scene;
  log.feed->show(log.index->end);
  roster.update(log.index->end, scene);
  ASSERT_EQ(scene.guests.size(), 2u);
  log.feed->show(log.index->begin - Duration::ms(1));
  roster.update(log.index->begin - Duration::ms(1), scene);
  EXPECT_TRUE(scene.guests.empty());
  EXPECT_FALSE(scene.music);
}

TEST_F(ReplayFeedTest, KnowsWhenEachBeatWasHeard) {
  write_couple(4.0);
  Opened log(path_);
  ASSERT_TRUE(log.feed) << log.failure;
  for (const double beat : {2.0, 5.0, 5.5}) {
    const auto time = log.index->time_of_beat(beat);
    ASSERT_TRUE(time) << beat;
    EXPECT_NEAR((*time - logged_second(0.5 * beat)).as_seconds(), 0.0, 1e-3) << beat;
  }
  EXPECT_FALSE(log.index->time_of_beat(100.0));
}

TEST_F(ReplayFeedTest, NamesWhatCannotBeShown) {
  EXPECT_FALSE(Opened("/no/such.lcm").failure.empty());
  ASSERT_TRUE(writer_->flush());
  EXPECT_NE(Opened(path_).failure.find(path_), std::string::npos);
}

TEST_F(ReplayFeedTest, ALogThatCannotBeReadIsNotOneWithoutDancers) {
  // Which the kernel does not read at 0.
  const Opened log("/proc/self/mem");
  EXPECT_NE(log.failure.find("cannot be read to its end"), std::string::npos) << log.failure;
}

TEST_F(ReplayFeedTest, DamageIsPassedOver) {
  write_couple(2.0);
  const std::string garbage = "\xED\xA1\xDA\x01 no event";
  ASSERT_TRUE(
      writer_->append(kWallAhead_us, "POSE/stage/bob",
                      {reinterpret_cast<const std::uint8_t*>(garbage.data()), garbage.size()}));
  ASSERT_TRUE(writer_->flush());
  Opened log(path_);
  ASSERT_TRUE(log.feed) << log.failure;
  log.feed->show(log.index->end);
  EXPECT_GT(log.board.poses(), 200u);
}

}  // namespace
}  // namespace dance

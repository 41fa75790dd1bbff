// A recorded house, looked at as late as one likes.
#include "viewer/feed/log_feed.h"

#include <gtest/gtest.h>

#include "core/bus/encode.h"
#include "tests/test_folder.h"
#include "viewer/feed/stage_roster.h"

namespace dance {
namespace {

constexpr std::uint64_t kLogClock = 5;
constexpr std::int64_t kWallAhead_us = 1'700'000'000'000'000;

MonoTime logged_second(double s) { return MonoTime() + Duration::seconds(50.0 + s); }

class LogFeedTest : public ::testing::Test {
 protected:
  LogFeedTest() {
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

  TestFolder folder_{"log-feed"};
  std::string path_ = folder_.path("log.lcm");
  std::unique_ptr<LogWriter> writer_;
};

TEST_F(LogFeedTest, ShowsTheStageOfAnyMomentInTheHousesOwnTime) {
  write_couple(4.0);
  auto feed = LogFeed::open(path_, false);
  ASSERT_TRUE(feed) << feed.error().what;
  EXPECT_NEAR((feed->begin() - logged_second(0.0)).as_seconds(), 0.0, 1e-5);
  EXPECT_NEAR((feed->end() - logged_second(4.0)).as_seconds(), 0.0, 0.02);
  StageRoster roster(feed->board());
  SceneState scene;
  for (const double s : {1.0, 3.0}) {
    feed->go_on_to(logged_second(s));
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

TEST_F(LogFeedTest, ShowsWhatACameraRecordedWithoutAStage) {
  for (int i = 0; i < 120; ++i) {
    Pose pose = pose_of(i / 30.0, kNoMusic);
    pose.stamp(Hop::kPublished, logged_second(i / 30.0));
    write(i / 30.0, Channel::of(Signal::kPose, Where::kCapture, *GuestId::parse("alice")), pose);
  }
  ASSERT_TRUE(writer_->flush());
  auto feed = LogFeed::open(path_, false);
  ASSERT_TRUE(feed) << feed.error().what;
  EXPECT_NEAR((feed->begin() - logged_second(0.0)).as_seconds(), 0.0, 1e-5);
  feed->go_on_to(logged_second(2.0));
  StageRoster roster(feed->board());
  SceneState scene;
  roster.update(logged_second(2.0), scene);
  ASSERT_EQ(scene.guests.size(), 1u);
  EXPECT_NEAR(scene.guests[0].pose.p_WH_m.x(), 2.0, 0.04);
}

TEST_F(LogFeedTest, BeginsAgainWithTheClockGoingOn) {
  write_couple(4.0);
  auto feed = LogFeed::open(path_, false);
  ASSERT_TRUE(feed);
  StageRoster roster(feed->board());
  SceneState scene;
  feed->go_on_to(feed->end());
  const MonoTime end = feed->end();
  feed->begin_again();
  const MonoTime now = end + Duration::s(1);
  feed->go_on_to(now);
  roster.update(now, scene);
  ASSERT_EQ(scene.guests.size(), 2u);
  EXPECT_NEAR(scene.guests[0].pose.p_WH_m.x(), 1.0, 0.04);
  EXPECT_NEAR((now - scene.guests[0].pose.capture_time).as_seconds(), 0.0, 0.04);
  EXPECT_NEAR((now - scene.guests[1].pose.capture_time).as_seconds(), 0.1, 0.04);
  EXPECT_NEAR((feed->end() - end).as_seconds(), 4.0, 0.04);
}

TEST_F(LogFeedTest, KnowsWhenEachBeatWasHeard) {
  write_couple(4.0);
  auto feed = LogFeed::open(path_, false);
  ASSERT_TRUE(feed);
  for (const double beat : {2.0, 5.0, 5.5}) {
    const auto time = feed->time_of_beat(beat);
    ASSERT_TRUE(time) << beat;
    EXPECT_NEAR((*time - logged_second(0.5 * beat)).as_seconds(), 0.0, 1e-3) << beat;
  }
  EXPECT_FALSE(feed->time_of_beat(100.0));
}

TEST_F(LogFeedTest, NamesWhatCannotBeShown) {
  EXPECT_FALSE(LogFeed::open("/no/such.lcm", false));
  ASSERT_TRUE(writer_->flush());
  const auto empty = LogFeed::open(path_, false);
  ASSERT_FALSE(empty);
  EXPECT_NE(empty.error().what.find(path_), std::string::npos);
}

TEST_F(LogFeedTest, ALogThatCannotBeReadIsNotOneWithoutDancers) {
  const auto feed = LogFeed::open("/proc/self/mem", false);  // which the kernel does not read at 0
  ASSERT_FALSE(feed);
  EXPECT_NE(feed.error().what.find("cannot be read to its end"), std::string::npos)
      << feed.error().what;
}

TEST_F(LogFeedTest, DamageIsPassedOver) {
  write_couple(2.0);
  const std::string garbage = "\xED\xA1\xDA\x01 no event";
  ASSERT_TRUE(
      writer_->append(kWallAhead_us, "POSE/stage/bob",
                      {reinterpret_cast<const std::uint8_t*>(garbage.data()), garbage.size()}));
  ASSERT_TRUE(writer_->flush());
  auto feed = LogFeed::open(path_, false);
  ASSERT_TRUE(feed);
  feed->go_on_to(feed->end());
  EXPECT_GT(feed->board().poses(), 200u);
}

}  // namespace
}  // namespace dance

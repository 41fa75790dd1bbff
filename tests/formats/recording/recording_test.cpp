#include "formats/recording/recording.h"

#include <gtest/gtest.h>

#include <vector>

#include "formats/recording/clip_source.h"
#include "formats/recording/log_sink.h"
#include "formats/recording/log_source.h"
#include "formats/recording/steady_clip.h"
#include "tests/formats/recording/recorded_night.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

TEST(Recording, TellsWhatItWasToldInTheOrderOfTime) {
  const Recording night = recorded_night(60);
  Recording again;
  night.play_into(again);
  expect_same_poses(night, again);
  expect_same_hands_and_beats(night, again);

  struct Times : RecordingSink {
    void on_skeleton(const GuestId&, const Skeleton&, std::int64_t us) override { take(us); }
    void on_pose(const GuestId&, const Pose&, std::int64_t us) override { take(us); }
    void on_hands(const GuestId&, const Hands&, std::int64_t us) override { take(us); }
    void on_beat(const Beat&, std::int64_t us) override { take(us); }
    void take(std::int64_t us) {
      EXPECT_GE(us, last_us);
      last_us = us;
      ++count;
    }
    std::int64_t last_us = 0;
    int count = 0;
  } times;
  night.play_into(times);
  EXPECT_EQ(times.count, 2 + 120 + 60 + 4);
}

TEST(Recording, KeepsNoMoreThanItsLimitsAndCountsTheRest) {
  RecordingLimits limits;
  limits.guests = 1;
  limits.poses = 10;
  limits.hands = 5;
  limits.beats = 1;
  Recording bounded(limits);
  recorded_night(20).play_into(bounded);
  ASSERT_EQ(bounded.guests().size(), 1u);
  EXPECT_EQ(bounded.guests()[0].poses.size(), 10u);
  EXPECT_EQ(bounded.guests()[0].hands.size(), 5u);
  EXPECT_EQ(bounded.beats().size(), 1u);
  EXPECT_EQ(bounded.overflow().guests, 1u + 20u);
  EXPECT_EQ(bounded.overflow().poses, 10u);
  EXPECT_EQ(bounded.overflow().hands, 15u);
  EXPECT_EQ(bounded.overflow().beats, 1u);
}

class LogOfANight : public testing::Test {
 protected:
  std::string write(const Recording& night, Where where, const char* name = "night.lcm") {
    const std::string path = folder_.path(name);
    auto writer = LogWriter::create(path);
    EXPECT_TRUE(writer.has_value()) << writer.error().what;
    LogSink sink(std::move(*writer), where);
    night.play_into(sink);
    EXPECT_TRUE(sink.finish().has_value());
    return path;
  }
  TestFolder folder_{"recording"};
};

TEST_F(LogOfANight, GivesBackWhatWasWritten) {
  const Recording night = recorded_night(130);
  auto source = LogSource::open(write(night, Where::kCapture));
  ASSERT_TRUE(source.has_value()) << source.error().what;
  EXPECT_EQ(source->where(), Where::kCapture);
  EXPECT_EQ(source->guests(), (std::vector<GuestId>{kAlice, kBob}));
  Recording read;
  ASSERT_TRUE(source->read_into(read).has_value());
  expect_same_poses(night, read);
  expect_same_hands_and_beats(night, read);
  EXPECT_EQ(read.find(kAlice)->skeletons.size(), 1u);  // though the log has it every second
}

TEST_F(LogOfANight, PublishesSkeletonsEverySecondWithTheClockOfTheirPoses) {
  UnpackedLog log = UnpackedLog::open(write(recorded_night(130), Where::kStage)).value();
  int skeletons = 0, poses_with_stamp = 0;
  while (const auto event = log.next()) {
    const auto channel = Channel::parse(event->channel);
    ASSERT_TRUE(channel.has_value());
    TimedSkeleton timed;
    Pose pose;
    if (decode(event->data.data(), event->data.size(), timed) == Decoded::kFine) {
      ++skeletons;
      EXPECT_EQ(timed.clock_id, kNightClock);
      EXPECT_TRUE(timed.capture_time.is_set());
    } else if (decode(event->data.data(), event->data.size(), pose) == Decoded::kFine) {
      EXPECT_EQ(channel->where(), Where::kStage);
      poses_with_stamp += pose.stamped(Hop::kStaged).is_set();
    }
  }
  EXPECT_EQ(skeletons, 2 * 3);  // in 2.2 s
  EXPECT_EQ(poses_with_stamp, 260);
}

TEST_F(LogOfANight, PrefersTheStageAndTakesWhatIsAskedFor) {
  Recording staged;
  recorded_night(10).play_into(staged);
  const std::string path = write(staged, Where::kStage);
  {
    auto writer = LogWriter::append_to(path);
    ASSERT_TRUE(writer.has_value());
    LogSink captures(std::move(*writer), Where::kCapture);
    recorded_night(25).play_into(captures);
    ASSERT_TRUE(captures.finish().has_value());
  }
  const auto count = [&](std::optional<Where> where) {
    auto source = LogSource::open(path, where);
    Recording read;
    EXPECT_TRUE(source.has_value() && source->read_into(read).has_value());
    return read.find(kAlice)->poses.size();
  };
  EXPECT_EQ(count({}), 10u);
  EXPECT_EQ(count(Where::kCapture), 25u);
  const auto none = LogSource::open(path, Where::kGuest);
  ASSERT_FALSE(none.has_value());
  EXPECT_NE(none.error().what.find("holds no poses on POSE/guest"), std::string::npos);
}

TEST(LogSource, ReadsThePackedLogOfThisTree) {
  auto source = LogSource::open(DANCE_SOURCE_DIR "/logs/couple-packed.lcm");
  ASSERT_TRUE(source.has_value()) << source.error().what;
  Recording read;
  ASSERT_TRUE(source->read_into(read).has_value());
  ASSERT_EQ(read.guests().size(), 2u);
  for (const RecordedGuest& guest : read.guests()) {
    EXPECT_EQ(guest.poses.size(), 640u);
    EXPECT_EQ(guest.hands.size(), 640u);
    EXPECT_EQ(guest.skeletons.size(), 1u);
  }
  EXPECT_EQ(read.beats().size(), 128u);
  EXPECT_EQ(source->skipped_bytes() + source->counters().undecodable, 0u);
}

TEST(SteadyClip, BringsHandsToTheTimesOfTheFrames) {
  SteadyClip clip(50.0);
  // Poses at 60 Hz, hands at 40 Hz whose first finger's angle tells the time.
  const auto at = [](double s) { return MonoTime::from_us(1'000'000) + Duration::seconds(s); };
  for (int i = 0; i < 120; ++i) {
    if (i % 3 != 1) {
      const double s = (i * 2 / 3) / 40.0;
      Hands hands;
      hands.capture_time = at(s);
      hands.R_PB[0] = Eigen::AngleAxisf(static_cast<float>(s), Eigen::Vector3f::UnitX());
      clip.add(hands);
    }
    Pose pose;
    pose.capture_time = at(i / 60.0);
    clip.add(pose);
  }
  const MotionClip whole = clip.with_hands();
  ASSERT_EQ(whole.hands.size(), whole.frames.size());
  ASSERT_NEAR(static_cast<double>(whole.frames.size()), 100.0, 1.0);
  for (std::size_t k = 0; k + 3 < whole.frames.size(); ++k)
    EXPECT_NEAR(Eigen::AngleAxisf(whole.hands[k].R_PB[0]).angle(), static_cast<float>(k) / 50.0f,
                2e-3f);
}

TEST(SteadyClip, KeepsEveryPoseOfATakeWhoseTimesAreRounded) {
  for (const std::int64_t hz : {30, 60}) {
    SteadyClip clip(static_cast<double>(hz));
    for (std::int64_t i = 0; i < 1941; ++i) {
      Pose pose;
      pose.p_WH_m.x() = static_cast<float>(i);
      pose.capture_time = MonoTime::from_us(5'000'000 + i * 1'000'000 / hz);
      clip.add(pose);
    }
    ASSERT_EQ(clip.body().frames.size(), 1941u) << hz;
    for (std::size_t f = 0; f < 1941; ++f)
      ASSERT_NEAR(clip.body().frames[f].p_WH_m.x(), static_cast<float>(f), 1e-3f) << hz;
  }
}

TEST(SteadyClip, HoldsHandsAcrossASilenceAndCountsWhatIsNotNewer) {
  SteadyClip clip(100.0, 40);
  Pose pose;
  Hands hands;
  for (int part = 0; part < 2; ++part) {
    for (int i = 0; i < 30; ++i) {
      pose.capture_time = hands.capture_time =
          MonoTime::from_us(1 + part * 60'000'000 + i * 10'000);
      if (part == 0) clip.add(hands);
      clip.add(pose);
    }
  }
  clip.add(pose);
  EXPECT_EQ(clip.counters().gaps, 1u);
  EXPECT_EQ(clip.counters().not_newer, 1u);
  EXPECT_EQ(clip.counters().beyond_bound, 20u);
  EXPECT_EQ(clip.with_hands().hands.size(), 40u);
}

TEST(ClipSource, PlaysClipsOfDifferentRatesSideBySide) {
  MotionClip slow, fast;
  slow.skeleton = fast.skeleton = average_skeleton();
  slow.frame_hz = 30.0;
  fast.frame_hz = 120.0;
  slow.frames.resize(30);
  fast.frames.resize(240);
  const std::vector<GuestClip> clips{{kAlice, &slow}, {kBob, &fast}};
  Recording read;
  play_clips_into(clips, kNight_us, read);
  ASSERT_NE(read.find(kAlice), nullptr);
  EXPECT_EQ(read.find(kAlice)->poses.size(), 30u);
  EXPECT_EQ(read.find(kBob)->poses.size(), 240u);
  EXPECT_EQ(read.find(kBob)->poses[120].time_us, kNight_us + 1'000'000);
  EXPECT_EQ(read.find(kBob)->poses[120].value.sequence, 121u);
}

}  // namespace
}  // namespace dance

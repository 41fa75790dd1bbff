#include "core/pose/clip.h"

#include <gtest/gtest.h>

#include "tests/allocation_guard.h"

namespace dance {
namespace {

// Ten frames at 10 Hz whose hips move 1 m along x per frame.
MotionClip walking() {
  MotionClip clip;
  clip.skeleton = average_skeleton();
  clip.frame_hz = 10.0;
  for (int i = 0; i < 10; ++i) {
    Pose pose;
    pose.p_WH_m.x() = static_cast<float>(i);
    clip.frames.push_back(pose);
  }
  return clip;
}

float x_at(const MotionClip& clip, double seconds, ClipEnd end) {
  Pose pose;
  sample_clip(clip, Duration::seconds(seconds), end, pose);
  return pose.p_WH_m.x();
}

TEST(MotionClip, LastsOnePeriodPerFrame) {
  EXPECT_EQ(walking().length(), Duration::s(1));
  EXPECT_EQ(MotionClip().length(), Duration());
}

TEST(SampleClip, GivesFramesAndWhatIsBetween) {
  const MotionClip clip = walking();
  for (const ClipEnd end : {ClipEnd::kHold, ClipEnd::kLoop}) {
    EXPECT_NEAR(x_at(clip, 0.0, end), 0.0f, 1e-5f);
    EXPECT_NEAR(x_at(clip, 0.3, end), 3.0f, 1e-5f);
    EXPECT_NEAR(x_at(clip, 0.35, end), 3.5f, 1e-5f);
    EXPECT_NEAR(x_at(clip, 0.9, end), 9.0f, 1e-5f);
  }
}

TEST(SampleClip, HoldsTheLastFrame) {
  EXPECT_NEAR(x_at(walking(), 0.95, ClipEnd::kHold), 9.0f, 1e-5f);
  EXPECT_NEAR(x_at(walking(), 1e6, ClipEnd::kHold), 9.0f, 1e-5f);
}

TEST(SampleClip, LoopsWithoutSlidingFromTheLastFrameToTheFirst) {
  const MotionClip clip = walking();
  EXPECT_NEAR(x_at(clip, 0.95, ClipEnd::kLoop), 9.0f, 1e-5f);
  EXPECT_NEAR(x_at(clip, 1.0, ClipEnd::kLoop), 0.0f, 1e-5f);
  EXPECT_NEAR(x_at(clip, 1.35, ClipEnd::kLoop), 3.5f, 1e-4f);
  EXPECT_NEAR(x_at(clip, 100.35, ClipEnd::kLoop), 3.5f, 1e-3f);
}

TEST(SampleClip, BeginsAtItsFirstFrameBeforeTheBeginning) {
  EXPECT_NEAR(x_at(walking(), -5.0, ClipEnd::kHold), 0.0f, 1e-5f);
  EXPECT_NEAR(x_at(walking(), -5.0, ClipEnd::kLoop), 0.0f, 1e-5f);
}

TEST(SampleClip, LeavesWhatThePlayerStampsAlone) {
  Pose pose;
  pose.sequence = 77;
  pose.clock_id = 5;
  pose.capture_time = MonoTime::from_us(123);
  pose.stamp(Hop::kPublished, MonoTime::from_us(456));
  sample_clip(walking(), Duration::ms(350), ClipEnd::kLoop, pose);
  EXPECT_EQ(pose.sequence, 77u);
  EXPECT_EQ(pose.clock_id, 5u);
  EXPECT_EQ(pose.capture_time, MonoTime::from_us(123));
  EXPECT_EQ(pose.stamped(Hop::kPublished), MonoTime::from_us(456));
}

TEST(SampleClip, PlaysAClipOfOneFrame) {
  MotionClip clip = walking();
  clip.frames.resize(1);
  for (const ClipEnd end : {ClipEnd::kHold, ClipEnd::kLoop})
    EXPECT_NEAR(x_at(clip, 12.34, end), 0.0f, 1e-5f);
}

TEST(SampleClip, AllocatesNothing) {
  const MotionClip clip = walking();
  Pose pose;
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) sample_clip(clip, Duration::ms(i * 17), ClipEnd::kLoop, pose);
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(SampleClipDeathTest, DiesOnAClipWithoutFrames) {
  Pose pose;
  EXPECT_DEATH(sample_clip(MotionClip(), Duration(), ClipEnd::kHold, pose), "empty");
}

}  // namespace
}  // namespace dance

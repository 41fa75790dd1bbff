// The synthetic salsa dancer steps on whole beats of a known music: each shift of the music is a
// known error.
#include "viewer/practice/step_score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "producers/salsa/salsa_dancer.h"
#include "tests/allocation_guard.h"
#include "viewer/practice/step_score_board.h"

namespace dance {
namespace {

constexpr std::uint64_t kClock = 7;

MonoTime at_s(double s) { return MonoTime::from_ns(static_cast<std::int64_t>((s + 1.0) * 1e9)); }

struct Lesson {
  double dance_bpm = 120.0;
  double music_bpm = 120.0;
  double late_ms = 0.0;  // of the dance
  double hz = 60.0;
  SalsaRole role = SalsaRole::kLead;
};

Beat beat_of(const Lesson& lesson, double s) {
  Beat beat;
  beat.time = beat.beat_time = at_s(s);
  beat.clock_id = kClock;
  beat.beat = s * lesson.music_bpm / 60.0;
  beat.tempo_bpm = lesson.music_bpm;
  beat.beats_per_bar = 4;
  beat.playing = true;
  return beat;
}

SalsaDancer dancer_of(const Lesson& lesson) {
  SalsaStyle style;
  style.tempo_bpm = lesson.dance_bpm;
  style.role = lesson.role;
  style.seed = 5;
  return SalsaDancer(style);
}

Pose pose_at(SalsaDancer& dancer, const Lesson& lesson, double s) {
  Pose pose;
  dancer.dance_at(Duration::seconds(s - 1e-3 * lesson.late_ms), pose);
  pose.capture_time = at_s(s);
  pose.clock_id = kClock;
  return pose;
}

// The figures shown over the last 30 s of a lesson.
struct LessonScore {
  double met = 0.0;  // mean share
  double late_ms = 0.0;
  int fewest_counted = StepScore::kBeats;
};
LessonScore shown_in(const Lesson& lesson) {
  SalsaDancer dancer = dancer_of(lesson);
  StepScore score;
  score.set_body(dancer.skeleton());
  BeatClock music;
  LessonScore shown;
  int asked = 0;
  double next_beat_s = 0.0;
  for (int i = 0; i < static_cast<int>(50.0 * lesson.hz); ++i) {
    const double s = 1.0 + i / lesson.hz;
    for (; next_beat_s <= s; next_beat_s += 0.1) music.hear(beat_of(lesson, next_beat_s));
    score.add(pose_at(dancer, lesson, s), music);
    if (s < 21.0) continue;
    const StepScore::Figures figures = score.figures();
    shown.fewest_counted = std::min(shown.fewest_counted, figures.counted);
    shown.met += figures.met_count() / static_cast<double>(std::max(1, figures.counted));
    shown.late_ms += static_cast<double>(figures.late_ms);
    ++asked;
  }
  shown.met /= asked;
  shown.late_ms /= asked;
  return shown;
}

TEST(StepScore, CountsAlmostAllBeatsOfADanceInTimeAndNoRests) {
  for (const double bpm : {100.0, 120.0, 184.0})
    for (const double hz : {30.0, 60.0})
      for (const SalsaRole role : {SalsaRole::kLead, SalsaRole::kFollow}) {
        const LessonScore shown = shown_in({bpm, bpm, 0.0, hz, role});
        EXPECT_GE(shown.met, 0.85) << bpm << " BPM, " << hz << " Hz";
        EXPECT_EQ(shown.fewest_counted, StepScore::kBeats) << "rests must not end the count";
      }
}

TEST(StepScore, TellsByHowMuchTheStepsAreLate) {
  const double base_ms = shown_in({}).late_ms;
  for (const double late_ms : {-80.0, -40.0, 40.0, 80.0})
    EXPECT_NEAR(shown_in({120.0, 120.0, late_ms}).late_ms - base_ms, late_ms, 15.0);
}

TEST(StepScore, StepsBeyondTheToleranceAreNotMet) {
  EXPECT_GE(shown_in({120.0, 120.0, 40.0}).met, 0.8);
  EXPECT_LE(shown_in({120.0, 120.0, 200.0}).met, 0.25) << "behind by 0.4 beats";
  EXPECT_LE(shown_in({120.0, 120.0, -200.0}).met, 0.25) << "ahead by 0.4 beats";
  // At 200 BPM a quarter of a beat is 75 ms.
  EXPECT_LE(shown_in({200.0, 200.0, 125.0}).met, 0.3);
}

TEST(StepScore, AnotherTempoMeetsHalfTheBeatsByLuckAtMost) {
  for (const double bpm : {109.0, 131.0}) {
    const LessonScore shown = shown_in({bpm, 120.0});
    EXPECT_LE(shown.met, 0.6) << bpm;
    EXPECT_GE(shown.met, 0.2) << bpm;
  }
}

TEST(StepScore, StartsAgainWhenTheMusicStopsOrJumpsOrTheDancerStands) {
  const Lesson lesson;
  SalsaDancer dancer = dancer_of(lesson);
  StepScore score;
  score.set_body(dancer.skeleton());
  BeatClock music;
  Pose pose;
  const auto dance = [&](double from_s, double to_s, double jump_beats, bool stands) {
    for (int i = static_cast<int>(from_s * 60.0); i < static_cast<int>(to_s * 60.0); ++i) {
      const double s = i / 60.0;
      Beat beat = beat_of(lesson, s);
      beat.beat += jump_beats;
      music.hear(beat);
      if (!stands) pose = pose_at(dancer, lesson, s);
      pose.capture_time = at_s(s);
      score.add(pose, music);
    }
  };
  dance(1.0, 15.0, 0.0, false);
  EXPECT_EQ(score.figures().counted, StepScore::kBeats);
  dance(15.0, 15.1, -20.0, false);
  EXPECT_EQ(score.figures().counted, 0) << "another song";
  dance(15.1, 30.0, -20.0, false);
  EXPECT_EQ(score.figures().counted, StepScore::kBeats);
  dance(30.0, 32.0, -20.0, true);
  EXPECT_EQ(score.figures().counted, StepScore::kBeats) << "a rest";
  dance(32.0, 42.0, -20.0, true);
  EXPECT_EQ(score.figures().counted, 0) << "stands";
  dance(42.0, 55.0, -20.0, false);
  EXPECT_EQ(score.figures().counted, StepScore::kBeats);
  Beat pause = beat_of(lesson, 55.0);
  pause.playing = false;
  music.hear(pause);
  pose.capture_time = at_s(55.1);
  score.add(pose, music);
  EXPECT_EQ(score.figures().counted, 0) << "no music";
}

TEST(StepScoreBoard, KeepsADancerOfThisHouseAndAllocatesNothing) {
  const Lesson lesson;
  SalsaDancer dancer = dancer_of(lesson);
  const GuestId alice = *GuestId::parse("alice");
  const auto board = std::make_unique<StepScoreBoard>(kClock);
  board->on_skeleton(alice, dancer.skeleton(), at_s(0.0));
  std::uint64_t allocations = 0;
  for (int i = 0; i < 60 * 20; ++i) {
    const double s = 1.0 + i / 60.0;
    Pose pose = pose_at(dancer, lesson, s);
    const AllocationGuard guard;
    board->on_beat(beat_of(lesson, s));
    board->on_pose(alice, pose, pose.capture_time);
    pose.clock_id = kClock + 1;  // of another machine
    board->on_pose(*GuestId::parse("bob"), pose, pose.capture_time);
    allocations += guard.allocations();
  }
  EXPECT_EQ(allocations, 0u);
  const auto found = board->find(std::nullopt, at_s(21.0));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->guest, alice);
  EXPECT_EQ(found->figures.counted, StepScore::kBeats);
  EXPECT_GE(found->figures.met_count(), 7);
  EXPECT_FALSE(board->find(*GuestId::parse("bob"), at_s(21.0)));
  EXPECT_FALSE(board->find(alice, at_s(26.0))) << "silent";
}

}  // namespace
}  // namespace dance

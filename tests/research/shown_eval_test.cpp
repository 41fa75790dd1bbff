#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "producers/salsa/salsa_dancer.h"
#include "research/capture/capture_eval.h"
#include "research/capture/capture_solve_eval.h"
#include "research/capture/shown_cases.h"

namespace dance {
namespace {

// Hands that swing, a body that turns to and fro.
ShownTrack swinging(std::size_t frames, double late_s) {
  ShownTrack track{30.0, {}};
  for (std::size_t f = 0; f < frames; ++f) {
    const double t = static_cast<double>(f) / track.hz - late_s;
    ShownFrame frame;
    frame.is_there = frame.has_facing = true;
    frame.facing_rad = 1.5 * std::sin(3.0 * t);
    for (Eigen::Vector3d& wrist : frame.wrist)
      wrist = {0.4 * std::sin(4.0 * t), 1.0, 0.3 * std::cos(2.3 * t)};
    track.frames.push_back(frame);
  }
  return track;
}

TEST(ShownEval, FindsLags) {
  const ShownFigures figures = shown_figures(swinging(300, 0.05), swinging(300, 0.0));
  EXPECT_NEAR(figures.hand_lag_ms.value_or(0.0), 50.0, 2.0);
  EXPECT_NEAR(figures.facing_lag_ms.value_or(0.0), 50.0, 2.0);
  EXPECT_EQ(figures.flips, 0);
}

TEST(ShownEval, LagsAreThoseOfTracksThatHaveOne) {
  ShownTrack still = swinging(300, 0.0);
  for (ShownFrame& frame : still.frames) {
    frame.facing_rad = 0.0;
    for (Eigen::Vector3d& wrist : frame.wrist) wrist = {0.3, 1.0, 0.0};
  }
  const ShownFigures moves = shown_figures(swinging(300, 0.05), swinging(300, 0.0)),
                     stands = shown_figures(still, still);
  EXPECT_FALSE(stands.hand_lag_ms);
  EXPECT_FALSE(stands.facing_lag_ms);
  const ShownFigures all = all_of({stands, moves, stands});
  EXPECT_NEAR(all.hand_lag_ms.value_or(0.0), *moves.hand_lag_ms, 1e-9);
  EXPECT_NEAR(all.facing_lag_ms.value_or(0.0), *moves.facing_lag_ms, 1e-9);
}

TEST(ShownEval, WristsAreJudgedBesideTheHips) {
  const ShownTrack truth = swinging(300, 0.0);
  ShownTrack shown = truth;
  for (ShownFrame& frame : shown.frames) {
    frame.hips_m.x() += 1.0;
    frame.wrist[0].x() += 1.0;
    frame.wrist[1].x() += 1.03;
  }
  const ShownFigures figures = shown_figures(shown, truth);
  EXPECT_NEAR(figures.wrist_error_mm, 15.0, 1e-6);
  EXPECT_NEAR(figures.wrist_error_p95_mm, 30.0, 1e-6);
}

TEST(ShownEval, TheTruthHasSoles) {
  std::vector<Pose> poses(4, still_posture(0));
  poses[2].p_WH_m.y() += 0.05f;
  poses[3].p_WH_m.y() -= 0.03f;
  const ShownTrack truth = truth_track(
      make_scene("still", average_skeleton(), poses, 30.0, SceneCamera(), no_errors(), 3));
  EXPECT_NEAR(truth.frames[0].lowest_m, 0.0, 0.001);
  EXPECT_NEAR(truth.frames[2].lowest_m, 0.05, 0.001);
  EXPECT_NEAR(truth.frames[3].lowest_m, -0.03, 0.001);
}

// The same dance, given 30 or 60 times a second: the same feet stand, and slide alike.
TEST(CaptureSolveEval, SlidingDoesNotDependOnTheRate) {
  SalsaDancer dancer{SalsaStyle()};
  std::array<SolveScore, 2> scores;
  for (std::size_t i = 0; i < 2; ++i) {
    const double hz = i == 0 ? 30.0 : 60.0;
    std::vector<Pose> poses(static_cast<std::size_t>(6.0 * hz));
    for (std::size_t f = 0; f < poses.size(); ++f)
      dancer.dance_at(Duration::seconds(static_cast<double>(f) / hz), poses[f]);
    scores[i] = evaluate_scene(
        make_scene("salsa", dancer.skeleton(), poses, hz, SceneCamera(), no_errors(), 3), {},
        Duration::s(2));
  }
  const auto [slow, quick] = std::pair{scores[0].truth, scores[1].truth};
  ASSERT_GT(slow.planted, 20u);
  EXPECT_NEAR(static_cast<double>(quick.planted), 2.0 * static_cast<double>(slow.planted),
              0.2 * static_cast<double>(slow.planted));
  EXPECT_NEAR(quick.slide_cm_s, slow.slide_cm_s, 1.0);
  // A take in which a foot hardly stands counts as little.
  SolveScore many, few;
  many.solver.planted = 99;
  many.solver.slide_cm_s = 2.0;
  few.solver.planted = 1;
  few.solver.slide_cm_s = 102.0;
  EXPECT_NEAR(mean_of({many, few}).solver.slide_cm_s, 3.0, 1e-9);
  EXPECT_NEAR(mean_of({few, many}).solver.slide_cm_s, 3.0, 1e-9);
}

TEST(ShownEval, CountsSolesFlipsAndTrembling) {
  ShownTrack truth = swinging(300, 0.0), shown = truth;
  for (ShownFrame& frame : truth.frames) frame.facing_rad = 0.2;
  for (std::size_t f = 0; f < shown.frames.size(); ++f) {
    ShownFrame& frame = shown.frames[f];
    frame.facing_rad = f >= 100 && f < 110 ? 3.0 : 0.2;
    // Below by 10 mm in 30 of 300 frames, 9 of them in the first 45; by 30 mm in 3.
    frame.lowest_m = f % 5 == 0 && f < 150 ? (f >= 135 ? -0.03 : -0.01) : 0.002;
    for (Eigen::Vector3d& wrist : frame.wrist) wrist = {f % 2 == 0 ? 0.004 : 0.0, 1.0, 0.0};
  }
  const ShownFigures figures = shown_figures(shown, truth);
  EXPECT_NEAR(figures.soles.over_5_percent, 10.0, 1e-9);
  EXPECT_NEAR(figures.soles.over_20_percent, 1.0, 1e-9);
  EXPECT_NEAR(figures.soles.worst_mm, 30.0, 1e-9);
  EXPECT_NEAR(figures.start_soles.over_5_percent, 20.0, 1e-9);
  EXPECT_EQ(figures.start_soles.over_20_percent, 0.0);
  EXPECT_EQ(figures.flips, 1);
  EXPECT_NEAR(figures.most_deg, 2.8 * 180.0 / std::numbers::pi, 0.1);
  EXPECT_NEAR(figures.fastest_deg_s, 30.0 * figures.most_deg, 1e-6);
  EXPECT_NEAR(figures.hand_p50_mm, 4.0, 1e-9);
  // Without a truth: there and back.
  EXPECT_EQ(shown_figures(shown, {30.0, {}}).flips, 2);
}

TEST(ShownEval, WhatIsShownKeepsWhatIsPromised) {
  const SalsaDancer dancer{SalsaStyle()};
  CodecTake take{"salsa", dancer.skeleton(), 30.0, std::vector<Pose>(150)};
  SalsaDancer dances = dancer;
  for (std::size_t i = 0; i < take.poses.size(); ++i)
    dances.dance_at(Duration::seconds(static_cast<double>(i) / take.hz), take.poses[i]);
  const std::vector<ShownRow> rows = shown_rows({take}, SceneCamera(), {}, {2, 1});
  ASSERT_EQ(rows.size(), 6u);
  double worst_mm = 0.0;
  for (const ShownRow& row : rows) {
    EXPECT_LE(row.now.soles.worst_mm, 5.0) << row.name;
    EXPECT_LE(row.now.fastest_deg_s, 720.0) << row.name;
    worst_mm = std::max(worst_mm, row.before.soles.worst_mm);
  }
  EXPECT_GT(worst_mm, 20.0);
  // Five seconds of small movements tell it to half a frame; of recorded takes it is in the docs.
  EXPECT_LE(rows[0].now.hand_lag_ms.value(), rows[0].before.hand_lag_ms.value() + 20.0);
  EXPECT_LE(rows[0].now.wrist_error_mm, rows[0].before.wrist_error_mm + 3.0);
  EXPECT_FALSE(rows[4].truth.hand_lag_ms);
  EXPECT_GT(rows[1].flipped, 5);
  EXPECT_LT(rows[1].now.facing_error_deg, 20.0);
  EXPECT_LE(rows[4].now.hand_p99_mm, 8.0);
  EXPECT_GT(rows[4].before.hand_p99_mm, 20.0);
  EXPECT_NE(shown_table(rows).find("standing still"), std::string::npos);
}

// The original's smoother of metres goes on where a frame is lost.
TEST(CaptureEval, TellsWhetherMetresGoOnAfterALoss) {
  CaptureRun lost, whole;
  for (int i = 0; i < 60; ++i) {
    CapturedPerson person;
    person.body.found = i != 30;
    person.body.capture_time = MonoTime() + Duration::ms(1000 + 33 * i);
    for (Eigen::Vector3f& p : person.body.world_m) p.setConstant(i % 2 ? 0.51f : 0.49f);
    person.unfiltered = person.body;
    lost.frames.push_back({"", {person}});
    person.body.found = true;
    whole.frames.push_back({"", {person}});
  }
  // A smoother that goes on, and one that does not.
  for (const bool goes_on : {true, false}) {
    BodySmoothing smoothing;
    for (EvaluatedFrame& frame : lost.frames) {
      CapturedPerson& person = frame.people[0];
      if (!person.body.found) {
        goes_on ? smoothing.lose() : smoothing.reset();
        continue;
      }
      SeenBody seen;
      seen.image_px = person.unfiltered.image_px;
      seen.world_m = person.unfiltered.world_m;
      seen.visibility = person.unfiltered.visibility;
      seen.next_px = {Eigen::Vector2f(100.0f, 100.0f), Eigen::Vector2f(100.0f, 300.0f)};
      smoothing.smooth(person.body.capture_time, false, seen);
      person.body.world_m = seen.world_m;
    }
    const LossComparison after = compare_after_loss(lost, whole, 30);
    EXPECT_EQ(after.frames, 20);
    EXPECT_LT(goes_on ? after.from_continued_mm : after.from_begun_anew_mm, 0.001);
    EXPECT_GT(goes_on ? after.from_begun_anew_mm : after.from_continued_mm, 0.5);
  }
}

}  // namespace
}  // namespace dance

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "producers/salsa/salsa_dancer.h"
#include "research/capture/capture_eval.h"
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
  EXPECT_NEAR(figures.hand_lag_ms, 50.0, 2.0);
  EXPECT_NEAR(figures.facing_lag_ms, 50.0, 2.0);
  EXPECT_EQ(figures.flips, 0);
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
  EXPECT_LE(rows[0].now.hand_lag_ms, rows[0].before.hand_lag_ms + 10.0);
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
    CaptureFrame frame;
    frame.body.found = i != 30;
    frame.body.capture_time = MonoTime() + Duration::ms(1000 + 33 * i);
    for (Eigen::Vector3f& p : frame.body.world_m) p.setConstant(i % 2 ? 0.51f : 0.49f);
    frame.unfiltered = frame.body;
    lost.frames.push_back(frame);
    frame.body.found = true;
    whole.frames.push_back(frame);
  }
  // A smoother that goes on, and one that does not.
  for (const bool goes_on : {true, false}) {
    BodySmoothing smoothing;
    for (CaptureFrame& frame : lost.frames) {
      if (!frame.body.found) {
        goes_on ? smoothing.lose() : smoothing.reset();
        continue;
      }
      SeenBody seen;
      seen.image_px = frame.unfiltered.image_px;
      seen.world_m = frame.unfiltered.world_m;
      seen.visibility = frame.unfiltered.visibility;
      seen.next_px = {Eigen::Vector2f(100.0f, 100.0f), Eigen::Vector2f(100.0f, 300.0f)};
      smoothing.smooth(frame.body.capture_time, false, seen);
      frame.body.world_m = seen.world_m;
    }
    const LossComparison after = compare_after_loss(lost, whole, 30);
    EXPECT_EQ(after.frames, 20);
    EXPECT_LT(goes_on ? after.from_continued_mm : after.from_begun_anew_mm, 0.001);
    EXPECT_GT(goes_on ? after.from_begun_anew_mm : after.from_continued_mm, 0.5);
  }
}

}  // namespace
}  // namespace dance

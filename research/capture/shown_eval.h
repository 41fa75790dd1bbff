// What an audience sees of a dancer before the camera: soles below the floor, turns that no body
// makes, hands that tremble. From the first picture on, the start-up included.
//
// Units/frames: as the names say; W of testing/camera/capture_scene.h, floor at y = 0.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      what a track has no frames for is 0; where nothing moves, there is no lag.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/pose/kinematics.h"
#include "producers/camera/solver/body_solver.h"
#include "testing/camera/capture_scene.h"

namespace dance {

struct ShownFrame {
  bool is_there = false;
  bool is_flipped = false;  // of the truth: the network took a back for a front
  double lowest_m = 0.0;    // heels, balls and toes of both feet
  bool has_facing = false;
  double facing_rad = 0.0;  // about the vertical; 0 looks to the camera, +z
  Eigen::Vector3d hips_m = Eigen::Vector3d::Zero();  // their middle
  std::array<Eigen::Vector3d, 2> wrist;
};
struct ShownTrack {
  double hz = 30.0;
  std::vector<ShownFrame> frames;
};

// Shares are of the frames with a pose, all and those of the first 1.5 s.
struct SoleFigures {
  double over_5_percent = 0.0, over_20_percent = 0.0, worst_mm = 0.0;
  double lift_p50_mm = 0.0, lift_p99_mm = 0.0;  // of the lower sole above the floor
};
struct ShownFigures {
  SoleFigures soles, start_soles;
  double fastest_deg_s = 0.0, most_deg = 0.0;   // most: in one frame
  int flips = 0;                                // the facing is more than 90 degrees wrong
  double facing_error_deg = 0.0;                // 95 of 100 frames are better
  std::optional<double> facing_lag_ms;          // of spins
  double hand_p50_mm = 0.0, hand_p99_mm = 0.0;  // a frame
  std::optional<double> hand_lag_ms;            // of moving ones
  // Of wrists against the truth, the middle of the hips removed.
  double wrist_error_mm = 0.0, wrist_error_p95_mm = 0.0;
  int frames = 0, without_pose = 0;
};

ShownTrack truth_track(const CaptureScene& scene);
ShownTrack shown_track(const CaptureScene& scene, const SolverOptions& options);
// Of landmarks without a truth, `hz` a second.
ShownTrack shown_track(std::span<const BodyLandmarks> landmarks, double hz, const Pinhole& camera,
                       const SolverOptions& options);

// `truth` may have no frames: then there are no lags, errors are 0, and flips are turns by more
// than 90 degrees within 0.2 s.
ShownFigures shown_figures(const ShownTrack& shown, const ShownTrack& truth);
// Shares are means, lags those of the tracks that have one, fastest and worst are the largest.
ShownFigures all_of(const std::vector<ShownFigures>& figures);

}  // namespace dance

// The solver of the camera, judged: dances of known truth before a simulated camera, and beside it
// what the network's metres give without a solver: placed along the view by least squares, told in
// the true camera's stage.
//
// Units/frames: as the names say; W of testing/camera/capture_scene.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      scenes shorter than the warm-up give zeros.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "producers/camera/solver/body_solver.h"
#include "testing/camera/capture_scene.h"
#include "testing/camera/limb_joints.h"

namespace dance {

constexpr std::size_t kJudgedCount = kLimbJoints.size();

// A dance as somebody has it, frame by frame.
struct JudgedTrack {
  struct Frame {
    LimbPlaces joint;
    std::array<Eigen::Vector3d, 2> foot;  // what should not slide
    double lowest_m = 0.0;                // of the soles
    double bone_m[8] = {};                // upper arms, forearms, thighs, shanks
    int wrong_knees = 0, wrong_elbows = 0;
  };
  std::vector<Frame> frames;
};

struct SolveFigures {
  double relative_mm = 0.0;  // joints against the truth, the middle of the hips removed
  double absolute_mm = 0.0;  // on the stage
  double jerk_ratio = 0.0;   // third differences against the truth's
  double slide_cm_s = 0.0;   // of feet that stand, mean
  double slide_p95_cm_s = 0.0;
  std::size_t planted = 0;    // feet that stand, in all frames
  double below_mm = 0.0;      // deepest of a sole below the floor, 99 of 100 frames
  double bone_percent = 0.0;  // standard deviation of a bone's length over its mean, largest
  int wrong_knees = 0, wrong_elbows = 0;
  double lag_ms = 0.0;
};

struct SolveScore {
  SolveFigures truth, baseline, solver;
  double ns_per_frame = 0.0;  // of this thread's own time
  double camera_height_error_mm = 0.0, camera_pitch_error_deg = 0.0;
  double height_error_percent = 0.0;  // of the dancer
  int refused = 0;                    // frames without a pose
  std::size_t frames = 0;
};

SolveScore evaluate_scene(const CaptureScene& scene, const SolverOptions& options,
                          Duration warm_up);
SolveScore mean_of(const std::vector<SolveScore>& scores);

}  // namespace dance

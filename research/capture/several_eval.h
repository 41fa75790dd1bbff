// Several cameras without a board, judged: recorded dances before two simulated cameras that nobody
// placed, calibrated or synchronised, beside what the first of them knows alone.
//
// Units/frames: errors in C, the first camera's frame (producers/camera/pinhole.h): depth is along
//               its z. Millimetres, degrees, milliseconds.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      a take in which the cameras were never placed has settled_s < 0, and counts in no
//               mean but `placed`.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "producers/camera/solver/body_solver.h"
#include "research/codec_takes.h"
#include "testing/camera/capture_scene.h"

namespace dance {

struct SeveralCase {
  std::string name;
  double around_deg = 60.0;
  double distance_m = 3.0;  // of both, from the middle of the dance
  double later_ms = 23.0;   // the second camera's stamps
  double drift_ms_per_min = 0.0;
  double hz = 30.0;           // of the second camera
  bool hides_arm = false;     // the left arm is out of the first camera's sight, half of the time
  bool covers_first = false;  // for two seconds of every eight, once placed
  bool covers_second = false;
  bool moves_second = false;  // turned by 8 degrees, half-way
  bool is_exact = false;      // networks without errors
  bool keeps_bodies = false;  // the takes' own, instead of bodies that differ as adults do
};
std::vector<SeveralCase> several_cases();

struct DepthErrors {
  double hips_mm = 0.0;  // of the middle of the hips, along the first camera's view
  double hips_p95_mm = 0.0;
  double joints_mm = 0.0;    // of twelve joints
  double relative_mm = 0.0;  // in space, the middle of the hips removed
  double absolute_mm = 0.0;  // in space, before the first camera
  double step_p99_mm = 0.0;  // the hips' way from picture to picture beyond the true one
};

// How the body was got.
enum class SeenBy { kOne, kOneTold, kTwo, kTwoTold };  // told: the dancer's height
constexpr std::size_t kSeenByCount = 4;
const char* name_of(SeenBy how);

struct SeveralScore {
  SeveralCase what;
  std::array<DepthErrors, kSeenByCount> errors;
  int takes = 0;
  int placed = 0;
  double settled_s = -1.0;      // mean
  double turn_error_deg = 0.0;  // of the placed camera
  double place_error_mm = 0.0;
  double later_error_ms = 0.0;
  int moves = 0;
  double again_s = -1.0;        // from when the camera was moved to when it was placed again
  double us_per_picture = 0.0;  // beyond one camera's: placement and joint solve
  std::size_t frames = 0;
};

// A dance before its two cameras, and what their networks saw.
struct SeveralStage {
  CaptureScene first;
  EyeScene other;
  EyeScene moved;  // from half-way on
  double half_s = 1e9;
};
SeveralScore evaluate_stages(const SeveralCase& what, const std::vector<SeveralStage>& stages);
// Takes of 120 Hz.
SeveralScore evaluate_several(const SeveralCase& what, const std::vector<CodecTake>& takes);
std::string several_table(const std::vector<SeveralScore>& scores);
std::string several_json(const std::vector<SeveralScore>& scores);

}  // namespace dance

// dance display eval: what extrapolation to the photon is worth on recorded dances: the error of
// the pose that is shown some milliseconds after it was captured, against showing it as it came.
//
// Units/frames: mm, joints and ends of the body in W (root motion counts too).
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      evaluate_display() of takes without a second of poses judges nothing.
#pragma once

#include <string>
#include <vector>

#include "research/predict/predict_takes.h"

namespace dance {

struct DisplayEvalOptions {
  double hz = 60.0;  // of the poses that are heard
  std::vector<double> horizons_ms{16.0, 33.0, 50.0};
  double noise_deg = 0.0;
};

// Of one part of the body, where it is and how it is turned.
struct PartErrors {
  double held_mean_mm = 0.0, ours_mean_mm = 0.0;
  double held_mean_deg = 0.0, ours_mean_deg = 0.0;
};

struct DisplayErrors {
  double held_mean_mm = 0.0;
  double held_p95_mm = 0.0;
  double ours_mean_mm = 0.0;
  double ours_p95_mm = 0.0;
  PartErrors head, hands;       // what a headset shows of its own dancer and of a partner
  double below_floor_mm = 0.0;  // the most that a foot is lower than the floor and than it was
};

struct DisplayEval {
  std::vector<DisplayErrors> errors;  // of each horizon
  std::size_t moments = 0;
  double ns_per_pose = 0.0;
};

// A dance as it is heard, and as it was at all times.
struct DisplayTake {
  PredictTake heard;
  MotionClip danced;
};

Result<DisplayTake> load_display_take(const std::string& path, double hz);
DisplayEval evaluate_display(const std::vector<DisplayTake>& takes,
                             const DisplayEvalOptions& options);
std::string display_eval_table(const DisplayEval& eval, const DisplayEvalOptions& options);
std::string display_eval_json(const DisplayEval& eval, const DisplayEvalOptions& options);

}  // namespace dance

// Two eyes judged on drawn dancers whose distance is known, beside what one eye knows and what two
// runs of the pose network would.
//
// Units/frames: errors of the depth of the hips, along the left camera's z, in millimetres; of the
//               dancer's size in percent.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; the salsa dancer needs no data.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "producers/camera/stereo/stereo_depth.h"
#include "research/codec_takes.h"
#include "testing/camera/drawn_rig.h"
#include "testing/camera/stereo_dancer.h"

namespace dance {

struct StereoEvalCase {
  std::string name;
  double distance_m = 3.0;
  double contrast = 25.0;
  double image_px = 1.75;
  double right_later_ms = 0.0;  // of two cameras that no wire triggers
};

struct ErrorSummary {
  double mean_mm = 0.0;
  double p95_mm = 0.0;
  double bias_mm = 0.0;
  double scale_mean_percent = 0.0;
};

// How the depth was got, in the order of StereoEval::errors.
enum class DepthWay { kStereo, kOneEye, kOneEyeKnownSize, kTwoNetworks };
constexpr std::size_t kDepthWayCount = 4;
const char* name_of(DepthWay way);

struct StereoEval {
  StereoEvalCase what;
  int frames = 0;
  int hinted = 0;
  double joints_mean = 0.0;
  std::array<ErrorSummary, kDepthWayCount> errors;  // each over the frames that got a hint
  double within_two_spreads = 0.0;                  // part of the hints
  double us_per_frame = 0.0;                        // of the thread's own time
  double row_offset_px = 0.0;
};

struct StereoEvalOptions {
  int frames = 60;
  int dancers = 6;  // of each case: other bodies, other sizes of the network's metres
  std::uint64_t seed = 1;
  bool is_calibration_exact = false;
};
std::vector<StereoEvalCase> stereo_eval_cases();
// Of the salsa dancer, where no takes are given.
StereoEval evaluate_stereo(const StereoEvalCase& what, const StereoEvalOptions& options,
                           const std::vector<CodecTake>& takes = {});

std::string stereo_eval_table(const std::vector<StereoEval>& evals);
std::string stereo_eval_json(const std::vector<StereoEval>& evals);

}  // namespace dance

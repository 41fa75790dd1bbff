// Two dancers before one camera, judged beside the same dancers drawn alone: who is taken for whom,
// by whose points alone a body's are nearer to, and the wrists of the shown bodies.
//
// Units/frames: as the names say; W of drawn_couple.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      an Error names the network that is missing, or what cannot be drawn.
#pragma once

#include <string>
#include <vector>

#include "producers/camera/people/people_estimator.h"
#include "research/capture/couple/drawn_couple.h"

namespace dance {

struct IdentityFigures {
  std::size_t frames = 0;  // of both dancers, outside of full occlusion
  std::size_t right = 0, wrong = 0, missing = 0;
  double longest_wrong_s = 0.0;
  double right_percent() const {
    return frames ? 100.0 * static_cast<double>(right) / static_cast<double>(frames) : 0.0;
  }
};
struct WristFigures {
  // The middle of the hips removed.
  double all_mm = 0.0, in_hold_mm = 0.0, in_hold_median_mm = 0.0;
  double hips_mm = 0.0;  // of the hips' middle from the truth, the mean offset removed
  std::size_t frames = 0, frames_in_hold = 0;
};
struct CoupleScore {
  std::string name;
  IdentityFigures separate;  // two estimators that each follow one person: the baseline
  IdentityFigures people;
  WristFigures alone, together;
  PeopleCounters counters;
  double ms_median = 0.0, ms_p95 = 0.0;  // of processor time: picture to both poses
  double alone_ms_median = 0.0;          // one dancer alone
};

struct CoupleWishes {
  PoseNetworkModel model = PoseNetworkModel::kFull;
  std::size_t first_frame = 0, most_frames = 1'000'000;
  bool has_baseline = true;  // of two estimators
  std::string log;           // a line for each picture with something to tell; "" none
};

Result<CoupleScore> evaluate_couple(DrawnCouple& couple, const CoupleWishes& wishes);
CoupleScore all_of(const std::vector<CoupleScore>& scores);

}  // namespace dance

// Whole bodies from few tracked points, judged on recorded dances: what TrackerBody makes of
// simulated devices beside what was danced.
//
// Units/frames: metres, seconds, degrees where the name says so.
// Ownership:    plain values.
// Threads:      evaluate_trackers uses two.
// Failure:      none.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "producers/trackers/tracker_body.h"
#include "research/trackers/human_take.h"

namespace dance {

enum class TrackerStart : std::uint8_t { kTPose, kDancing };

struct TrackerTrial {
  int points = 3;
  TrackerGuide guide = TrackerGuide::kGeometric;
  TrackerStart start = TrackerStart::kTPose;
};

struct TrackerEvalOptions {
  double hz = 90.0;
  std::uint64_t seed = 1;
  std::shared_ptr<const TrackerModel> model;
};

// Means over frames; sums while they are made.
struct TrackerScore {
  double joints_m = 0.0;   // all 22, in W
  double body_m = 0.0;     // the same, hips laid on hips
  double turns_deg = 0.0;  // of each bone in its parent
  double hips_m = 0.0;
  double proportions_m = 0.0;  // of joints_m what true turns would have on the body that was found
  double slide_m_s = 0.0, true_slide_m_s = 0.0;
  double jerk_ratio = 0.0;
  double lost_m = 0.0;       // of the lost point's bone, while it is lost
  double lost_jump_m = 0.0;  // the largest step of a joint from frame to frame beyond the true one
  double median_us = 0.0, p99_us = 0.0;
  double height_error_m = 0.0, arm_error = 0.0;
  std::size_t frames = 0;
};

// What was solved, for those who want to look at it.
struct TrackerShow {
  PredictTake truth;
  Skeleton skeleton;
  std::vector<Pose> solved;
};

TrackerScore judge_trackers(const PredictTake& take, const TrackerTrial& trial,
                            const TrackerEvalOptions& options, TrackerShow* show = nullptr);

// Of all takes, weighted by their frames.
std::vector<TrackerScore> evaluate_trackers(const std::vector<PredictTake>& takes,
                                            const std::vector<TrackerTrial>& trials,
                                            const TrackerEvalOptions& options);

std::string trackers_eval_table(const std::vector<TrackerTrial>& trials,
                                const std::vector<TrackerScore>& scores);

}  // namespace dance

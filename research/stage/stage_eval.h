// How well a recorded couple dances in avatars: whether hands that meet still meet, whether soles
// are on the floor, whether wrists are wrung, and what the fitting costs in smoothness and time.
// Measured on the vertices and joints that are drawn, not on what the fitting worked with.
//
// Units/frames: as the names say. A foot stands while a point of its danced sole is within 3 cm of
//               the floor and its ball moves at less than 0.15 m/s. A palm is 40 % of the way from
//               the wrist to the finger tips.
// Ownership:    plain values.
// Threads:      none inside. Reads the processor's clock for the cost.
// Failure:      measures of what never happened in the take are nullopt.
#pragma once

#include <optional>
#include <string>

#include "research/stage/stage_take.h"
#include "viewer/figure/figure_poser.h"

namespace dance {

struct StageMeasures {
  std::size_t hand_meetings = 0;          // moments × pairs of palms of two dancers ≤ 3 cm
  std::optional<double> hand_gap_mm_p95;  // of the avatars' palms then
  std::optional<double> hand_gap_danced_mm_p95;  // … as danced
  std::size_t hold_moments = 0;                  // palms of two dancers ≤ 8 cm
  std::optional<double> hold_off_mm_p95;         // of one palm's place seen from the other
  std::optional<double> own_hands_off_mm_p95;    // likewise of a dancer's own two
  std::size_t standing_moments = 0;
  std::optional<double> foot_floor_mm_p95;  // sole's mesh to the floor
  std::optional<double> foot_floor_danced_mm_p95;
  double foot_below_mm_max = 0.0;         // of any moment
  std::optional<double> foot_slide_mm_s;  // mean speed of the ball of a standing foot
  std::optional<double> foot_slide_danced_mm_s;
  double wrist_twist_deg_max = 0.0;  // of the mesh, between forearm and hand
  double elbow_twist_deg_max = 0.0;
  double joint_step_mm_max = 0.0;         // by which a joint's place moves from frame to
  std::string joint_step_where;           // the bone, and when
  double joint_step_mm_p999 = 0.0;        // frame more than the dancer's
  double joint_step_danced_mm_max = 0.0;  // what the dancer's own moves
  double stretch_percent_max = 0.0;       // of arms
  double stretched_share_percent = 0.0;   // of the time × arms
  double us_per_figure = 0.0;             // median of the frames
};

StageMeasures measure_stage(const StageTake& take, const StageWear& wear, FigureOptions options);

struct StageEval {
  std::vector<std::string> dancers, avatars;
  std::size_t frames = 0;
  StageMeasures fitted;
  StageMeasures plain;  // the same avatars, without feet, hands and twist
};
StageEval evaluate_stage(const StageTake& take, const StageWear& wear);

std::string stage_eval_json(const StageEval& eval);
std::string stage_eval_table(const StageEval& eval);

}  // namespace dance

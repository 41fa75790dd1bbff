// How well holds are recognised on a stage, and how near arms that reach bring hands: on recorded
// couples, as they were captured, through the codec, and as a house shows them, one dancer here and
// the other over an emulated line, predicted.
//
// Units/frames: metres, seconds. Truth: palms of the recording within kTruth_m of each other.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      takes shorter than the warm-up add nothing.
#pragma once

#include <string>
#include <vector>

#include "research/touch/touch_stage.h"

namespace dance {

struct TouchRow {
  std::string stage, way;
  HoldFigures figures;
};
// How far palms are apart on the stage while the recording has them together.
struct GapRow {
  std::string stage;
  double plain_p50_mm = 0.0, plain_p95_mm = 0.0;      // as shown without hold-hands
  double reached_p50_mm = 0.0, reached_p95_mm = 0.0;  // with it
  double step_plain_mm = 0.0, step_reached_mm = 0.0;  // p99 of a palm's way from picture to picture
};

struct TouchEval {
  std::vector<TouchRow> rows;
  std::vector<GapRow> gaps;
  double us_a_pose = 0.0;     // of StageHolds, median
  double us_a_picture = 0.0;  // of StageTouch, for the couple
};

TouchEval evaluate_touch(const std::vector<CoupleTake>& couples, const TouchLine& line);
std::string touch_eval_table(const TouchEval& eval);
std::string touch_eval_json(const TouchEval& eval);

}  // namespace dance

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

#include "research/predict/couple_takes.h"
#include "transformers/flow.h"
#include "transformers/touch/palm_hold.h"

namespace dance {

constexpr float kTruth_m = 0.08f;

struct TouchLine {
  Duration delay = Duration::ms(60);
  Duration jitter = Duration::ms(15);
  double loss_percent = 1.0;
  double noise_deg = 0.5;
  std::vector<std::string> through{"predict", "bridge"};
  FlowParts parts;
  Duration warm_up = Duration::s(4);
  PalmHold::Limits limits;
};

// Of one way to recognise holds on one stage.
struct HoldFigures {
  std::size_t true_frames = 0;   // pairs of palms × pictures within kTruth_m in the recording
  std::size_t found_frames = 0;  // of these, reported
  std::size_t held_frames = 0;   // reported
  std::size_t apart_frames = 0;  // of these, over twice kTruth_m apart in the recording
  std::size_t holds = 0;         // reported, from begin to end
  std::size_t false_holds = 0;   // of these, without any true frame within them
  std::size_t far_holds = 0;     // of these, never within 1.5 times kTruth_m
  std::size_t true_holds = 0;    // in the recording
  std::size_t breaks = 0;        // ends of a reported hold within a true one
  double seconds = 0.0;
  double found() const;
  double per_minute(std::size_t count) const;
};

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

// What the station `stylize` does to recorded dances, measured from outside, without its own
// filters: the gain at the harmonics of the bar by least squares over the whole take, the mean
// pose, bones, feet, other zones, smoothness.
//
// Units/frames: as the names say. The deviations of a zone: its bones' turns from their mean over
//               the take, rad; of the hips their tilt, and their sway over the feet, metres.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      measures of takes shorter than the warm-up are 0.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "research/codec_takes.h"
#include "transformers/style/body_zones.h"
#include "transformers/style/style_presets.h"

namespace dance {

struct StylizeEvalOptions {
  BodyZone zone = BodyZone::kHips;
  double gain = 1.5;
  double mix = kUsualMix;  // 0: only what comes again with each bar … 1: all of the motion
  double warm_up_s = 8.0;  // not measured
  bool untagged = false;   // poses come without musical time
};

// A take as it is danced, and where in the music.
struct StyleTake {
  std::string name;
  Skeleton skeleton;
  double hz = 60.0;
  double tempo_bpm = 0.0;
  std::vector<Pose> poses;  // with capture times, and musical time where it is known
};

// `tempo_off_percent`: told a tempo that is off by so much, what is measured is chance.
StyleTake style_take_of(const CodecTake& take, double tempo_off_percent = 0.0);
// Takes of one dancer that follow each other as one long dance, each on its own beat; who is
// another body begins another.
std::vector<StyleTake> joined(std::span<const StyleTake> takes);
// A body that sways at known harmonics, with a drift and half a degree of noise: two minutes.
StyleTake synthetic_sway(double hz);

struct StylizeEval {
  std::string name;
  double measured_gain = 0.0;        // at the bar's harmonics
  double phase_deg = 0.0;            // by which they are later
  double overall_gain = 0.0;         // of all deviation from the mean
  double periodic_share = 0.0;       // of the deviation's energy, in the harmonics
  double mean_pose_shift_deg = 0.0;  // largest of the zone's bones
  double bone_length_error_mm = 0.0;
  double other_zones_change_deg =
      0.0;  // largest; for hips and legs, which are solved anew, without the legs
  double feet_moved_mm = 0.0;  // largest, of an ankle; 0.0 means that feet stand where they stood
  double feet_moved_p99_mm = 0.0;
  double slide_mm_s = 0.0;         // of balls of feet that stand …
  double danced_slide_mm_s = 0.0;  // … and as they were danced
  double jerk_ratio = 0.0;
  double swing_gain = 0.0;   // of legs: of their joints' turns while the foot swings
  double swing_share = 0.0;  // of the time
  double ns_per_pose = 0.0;
  bool is_identical = false;
  double line_energy = 0.0;  // what the gain was measured on, to weigh takes by
};

StylizeEval evaluate_stylize(const StyleTake& take, const StylizeEvalOptions& options);
// Of several takes: gains weighed by energy, the largest of what should be nothing.
StylizeEval sum_up(std::span<const StylizeEval> takes);

std::string stylize_eval_json(const StylizeEval& all, std::span<const StylizeEval> takes,
                              const StylizeEvalOptions& options);
std::string stylize_eval_table(const StylizeEval& all, std::span<const StylizeEval> takes,
                               const StylizeEvalOptions& options);

}  // namespace dance

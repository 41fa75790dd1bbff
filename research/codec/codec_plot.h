// A picture of what the pose codec's bytes buy: the mean size of a frame over the largest error
// that any joint may have, a line for each age of the references, beside what simpler ways take.
//
// Units/frames: errors in millimetres, both axes logarithmic; sizes in bytes of payload a frame.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      an Error says that gnuplot is missing or failed. What is not above 0 has no place
//               on a logarithmic axis and is left out.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "research/codec/codec_eval.h"

namespace dance {

struct RatePoint {
  double error_mm = 0.0;
  double bytes = 0.0;
};

struct RateSeries {
  std::string name;
  std::vector<RatePoint> points;  // by rising error
};

// Something to compare with. Whose error is not known is a level, not a point.
struct RateMark {
  std::string name;
  double bytes = 0.0;
  std::optional<double> error_mm;
};

struct RatePlot {
  std::string title;
  std::vector<RateSeries> series;  // the largest first, as the legend lists them
  std::vector<RateMark> marks;
};

constexpr std::array<double, 5> kPlotErrors_mm{0.25, 0.5, 1.0, 2.0, 5.0};

// Intra frames and references 4, 2 and 1 frames old at each of these errors; `eval` is of the same
// takes.
RatePlot measure_rates(const std::vector<CodecTake>& takes, const CodecEvalOptions& options,
                       const CodecEval& eval);

// What gnuplot is told to draw.
std::string rate_plot_script(const RatePlot& plot);
// Replaces the file.
Result<void> draw_rate_plot(const RatePlot& plot, const std::string& svg_file);

}  // namespace dance

// All zones at three mixes over several takes: one row each, of all takes and of the worst.
//
// Units/frames: as StylizeEval has them.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      of no takes there are no rows.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "research/style/stylize_eval.h"

namespace dance {

struct StylizeRow {
  StylizeEvalOptions asked;
  StylizeEval all;  // as sum_up() has it
  double least_gain = 0.0, most_gain = 0.0;
  std::size_t takes = 0, takes_within = 0;  // 6 % of what was asked for
  double median_mean_shift_deg = 0.0;
};

// The zone and the mix of `asked` are not looked at.
std::vector<StylizeRow> stylize_overview(std::span<const StyleTake> takes,
                                         const StylizeEvalOptions& asked);

std::string stylize_overview_table(std::span<const StylizeRow> rows);
std::string stylize_overview_json(std::span<const StylizeRow> rows);

}  // namespace dance

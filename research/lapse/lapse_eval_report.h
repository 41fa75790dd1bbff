// What dance lapse eval prints: a table for people, JSON for scripts.
//
// Units/frames: millimetres, ratios.
// Ownership:    plain values.
// Threads:      none.
// Failure:      none.
#pragma once

#include <string>
#include <vector>

#include "research/lapse/lapse_eval.h"

namespace dance {

struct LapseRow {
  Duration length;
  std::string subject;
  LapseFigures figures;
};

std::string lapse_table(const std::vector<LapseRow>& rows);
std::string lapse_json(const std::vector<LapseRow>& rows);

}  // namespace dance

// How much the figures of `dance touch eval` depend on luck: the same dances over lines of several
// delays, with noise, jitter and losses of several seeds; and on limits that were chosen on other
// dances than those that are judged.
//
// Units/frames: as research/touch/touch_stage.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      takes shorter than the warm-up add nothing.
#pragma once

#include <string>
#include <vector>

#include "research/touch/touch_stage.h"

namespace dance {

struct SpreadWish {
  std::vector<Duration> delays;
  std::size_t seeds = 5;  // from the line's own on
  bool chooses = false;   // limits for each dance on the others
};

struct SpreadRow {
  Duration delay;
  std::string way;
  std::vector<HoldFigures> figures;  // of all dances, one for each seed
};

struct TouchSpread {
  std::size_t dances = 0;
  std::vector<SpreadRow> rows;
  std::vector<PalmHold::Limits> chosen;  // for each dance on the others
};

TouchSpread evaluate_spread(const std::vector<CoupleTake>& couples, const TouchLine& line,
                            const SpreadWish& wish);
std::string touch_spread_table(const TouchSpread& spread);
std::string touch_spread_json(const TouchSpread& spread);

}  // namespace dance

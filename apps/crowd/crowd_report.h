// What a crowd saw, for people and for scripts: a line each second, and the sum at the end.
//
// Units/frames: as the texts say; those of the JSON stand in its names.
// Ownership:    new texts.
// Threads:      any.
// Failure:      none.
#pragma once

#include <string>

#include "apps/crowd/crowd_run.h"

namespace dance {

std::string crowd_heading();
std::string crowd_second_line(const CrowdSecond& second);
std::string crowd_second_json(const CrowdSecond& second);
std::string crowd_summary_text(const CrowdPlan& plan, const CrowdSummary& summary);
std::string crowd_summary_json(const CrowdPlan& plan, const CrowdSummary& summary);

}  // namespace dance

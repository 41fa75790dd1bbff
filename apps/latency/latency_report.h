// What `dance latency` prints: the table of each guest's journey, or the same as JSON.
//
// Units/frames: microseconds.
// Threads:      none inside.
// Failure:      none; what could not be measured is said in words.
#pragma once

#include <string>

#include "apps/latency/latency_journey.h"

namespace dance {

struct LatencyScope {
  std::string bus_url;
  double seconds = 0.0;
};

// One guest's rows and notes, without a headline.
std::string journey_table(const GuestJourney& guest);
std::string latency_table(const Journeys& journeys, const LatencyScope& scope);
std::string latency_json(const Journeys& journeys, const LatencyScope& scope);

}  // namespace dance

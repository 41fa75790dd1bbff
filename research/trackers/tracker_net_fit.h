// Fits a network of tracked bodies to recorded dances.
//
// Units/frames: as producers/trackers/net/tracker_features.h.
// Ownership:    plain values.
// Threads:      two while it fits. The same dances and seed give the same network.
// Failure:      none; wants at least one dance.
// Source:       Adam (Kingma and Ba, 2015); the mean of the last parameters (Polyak and Juditsky,
//               1992).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "producers/trackers/net/tracker_net.h"
#include "research/trackers/tracker_samples.h"

namespace dance {

struct TrackerFit {
  int rounds = 4000;  // each of 32 sequences of 2.4 s
  std::uint64_t seed = 1;
  std::function<void(const std::string&)> tell = [](const std::string&) {};
};

TrackerNet fit_tracker_net(const std::vector<TrackerDance>& dances, const TrackerFit& fit);

}  // namespace dance

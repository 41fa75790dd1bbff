// TrackerModel: the network that guesses bodies, in a file. `dance trackers train` makes one;
// data/trackers/body.model is built in.
//
// Units/frames: as tracker_net.h. In the file each column of weights is of 16-bit numbers and a
//               scale.
// Ownership:    a value that many solvers may share.
// Threads:      none inside; const calls may run at the same time.
// Failure:      read_tracker_model names what is wrong with a file; what it accepts is finite and
//               within bounds.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "producers/trackers/net/tracker_net.h"

namespace dance {

struct TrackerModel {
  TrackerNet net;
  std::uint32_t name = 0;  // of the file it was read from
};

// Weights beyond what a file can hold are our bug.
std::vector<std::uint8_t> write_tracker_model(const TrackerModel& model);
Result<std::shared_ptr<const TrackerModel>> read_tracker_model(std::span<const std::uint8_t> file);
std::shared_ptr<const TrackerModel> built_in_tracker_model();

}  // namespace dance

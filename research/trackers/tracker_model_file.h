// A model of tracked bodies in a file.
//
// Units/frames: none.
// Ownership:    the caller owns what is read.
// Threads:      one.
// Failure:      an Error names the file and what is wrong with it.
#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "producers/trackers/net/tracker_model.h"

namespace dance {

Result<std::shared_ptr<const TrackerModel>> read_tracker_model_file(const std::string& path);
Result<void> write_tracker_model_file(const TrackerModel& model, const std::string& path);

}  // namespace dance

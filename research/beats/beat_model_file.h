// A model of beats in a file.
//
// Threads: one.
// Failure: an Error names the file and what is wrong with it.
#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "producers/music/tracker/beat_model.h"

namespace dance {

Result<std::shared_ptr<const BeatModel>> read_beat_model_file(const std::string& path);
Result<void> write_beat_model_file(const BeatModel& model, const std::string& path);

}  // namespace dance

// Where the trained networks lie on this machine, and reading them.
//
// Ownership: what is returned owns its numbers.
// Threads:   none inside; reads files on the caller's thread.
// Failure:   an Error names the file that is missing or damaged, and the cure.
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"
#include "producers/camera/estimator/pose_graph.h"

namespace dance {

enum class PoseNetworkModel { kLite, kFull, kHeavy };
std::string_view name_of(PoseNetworkModel model);

// The folder of the options; "" where none is given: then the environment's DANCE_POSE_MODELS, and
// without it the first that has the detector in it of
//   data_folder()/pose                     the build's: models/pose of the source tree
//   $XDG_DATA_HOME/dancegraph/pose         where `dance fetch-models` of an installation puts them
//   /var/lib/dancegraph/pose               where root's puts them, for all users
// and the user's own where none has.
std::string pose_models_folder(const std::string& wished);

Result<PoseGraph> read_detector(const std::string& folder);
Result<PoseGraph> read_landmark_model(const std::string& folder, PoseNetworkModel model);

}  // namespace dance

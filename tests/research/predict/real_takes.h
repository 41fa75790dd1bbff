// Recorded dances beside the tree, as prediction is judged on them; where one is missing there are
// none, and tests skip.
//
// Units/frames: 60 frames a second, of each take the first ones.
// Ownership:    plain values.
// Threads:      none.
// Failure:      none: no takes.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "research/predict/predict_takes.h"

namespace dance {

inline std::vector<PredictTake> real_takes(const std::vector<std::string>& names,
                                           std::size_t frames) {
  std::vector<PredictTake> takes;
  for (const std::string& name : names) {
    const std::string path = DANCE_SOURCE_DIR "/../shared/data/mocap/" + name + ".bvh.xz";
    if (!std::filesystem::exists(path)) return {};
    auto take = load_predict_take(path, 60.0);
    if (!take) return {};
    take->poses.resize(std::min(take->poses.size(), frames));
    takes.push_back(std::move(*take));
  }
  return takes;
}

}  // namespace dance

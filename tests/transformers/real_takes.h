// Recorded dances beside the tree, for tests that can do without: where there are none, they skip.
//
// Units/frames: as core/pose/clip.h; capture times are 1/hz apart, from 1 s on; clock 1.
// Ownership:    plain values.
// Threads:      none.
// Failure:      a take that is missing or broken is left out.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "formats/bvh/clip_file.h"

namespace dance {

struct RealTake {
  std::string name;
  Skeleton skeleton;
  double hz;
  std::vector<Pose> poses;
};

inline std::vector<RealTake> real_takes(std::initializer_list<const char*> names) {
  std::vector<RealTake> takes;
  for (const char* name : names) {
    const std::string path =
        DANCE_SOURCE_DIR "/../shared/data/mocap/" + std::string(name) + ".bvh.xz";
    if (!std::filesystem::exists(path)) continue;
    auto loaded = load_clip(path);
    if (!loaded) continue;
    RealTake take{name, loaded->clip.skeleton, loaded->clip.frame_hz, {}};
    for (const Pose& frame : loaded->clip.frames) {
      Pose pose = frame;
      pose.sequence = static_cast<std::uint32_t>(take.poses.size());
      pose.clock_id = 1;
      pose.capture_time =
          MonoTime() + Duration::seconds(1.0 + static_cast<double>(take.poses.size()) / take.hz);
      take.poses.push_back(pose);
    }
    takes.push_back(std::move(take));
  }
  return takes;
}

}  // namespace dance

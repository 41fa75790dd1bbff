#include "tools/motion_take.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "producers/clip_file.h"

namespace dance {

Result<MotionTake> load_motion_take(const std::string& path, double hz) {
  DANCE_TRY(const LoadedClip loaded, load_clip(path));
  const MotionClip& clip = loaded.clip;
  const auto every = std::max<std::size_t>(
      1, static_cast<std::size_t>(std::lround(clip.frame_hz / std::max(hz, 1.0))));
  MotionTake take;
  take.name = std::filesystem::path(path).filename().string();
  take.skeleton = clip.skeleton;
  take.hz = clip.frame_hz / static_cast<double>(every);
  for (std::size_t i = 0; i < clip.frames.size(); i += every) {
    Pose pose = clip.frames[i];
    normalize(pose);
    pose.sequence = static_cast<std::uint32_t>(take.poses.size());
    pose.clock_id = 1;
    pose.capture_time =
        MonoTime() + Duration::seconds(1.0 + static_cast<double>(take.poses.size()) / take.hz);
    take.poses.push_back(pose);
  }
  if (take.poses.size() < 2) return fail(path + ": holds no motion, at least 2 frames are needed");
  return take;
}

}  // namespace dance

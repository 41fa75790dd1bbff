#include "research/codec_takes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "core/base/random.h"
#include "core/codec/plain_codec.h"
#include "formats/bvh/clip_file.h"

namespace dance {
namespace {

void shake(Pose& pose, double sd_deg, Random& random) {
  const double sd_rad = sd_deg * static_cast<double>(EIGEN_PI) / 180.0;
  for (auto& q : pose.R_PB) {
    const Eigen::Vector3d turn(random.normal() * sd_rad, random.normal() * sd_rad,
                               random.normal() * sd_rad);
    const double angle = turn.norm();
    if (angle > 0.0)
      q = q * Eigen::Quaternionf(
                  Eigen::AngleAxisf(static_cast<float>(angle), (turn / angle).cast<float>()));
  }
}

}  // namespace

Result<CodecTake> load_codec_take(const std::string& path, double hz, double jitter_deg) {
  DANCE_TRY(const LoadedClip loaded, load_clip(path));
  const MotionClip& clip = loaded.clip;
  CodecTake take;
  take.name = std::filesystem::path(path).filename().string();
  const auto every = std::max<std::size_t>(
      1, static_cast<std::size_t>(std::lround(clip.frame_hz / std::max(hz, 1.0))));
  take.hz = clip.frame_hz / static_cast<double>(every);
  std::array<std::uint8_t, kSkeletonPayload> bytes{};
  if (encode_skeleton(clip.skeleton, bytes) == 0 || !decode_skeleton(bytes, take.skeleton))
    return fail(path + ": the dancer's proportions cannot be sent");
  Random random(1);
  for (std::size_t i = 0; i < clip.frames.size(); i += every) {
    Pose pose = clip.frames[i];
    if (jitter_deg > 0.0) shake(pose, jitter_deg, random);
    normalize(pose);
    pose.sequence = static_cast<std::uint32_t>(take.poses.size());
    pose.capture_time =
        MonoTime() + Duration::seconds(1.0 + static_cast<double>(take.poses.size()) / take.hz);
    take.poses.push_back(pose);
  }
  if (take.poses.size() < 16) return fail(path + ": is too short, at least 16 frames are needed");
  return take;
}

Result<std::vector<CodecTake>> load_codec_takes(const std::vector<std::string>& paths, double hz,
                                                double jitter_deg) {
  std::vector<CodecTake> takes;
  for (const std::string& path : paths) {
    DANCE_TRY(CodecTake take, load_codec_take(path, hz, jitter_deg));
    takes.push_back(std::move(take));
  }
  return takes;
}

}  // namespace dance

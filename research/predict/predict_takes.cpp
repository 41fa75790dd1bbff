#include "research/predict/predict_takes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "core/motion/rotation_vector.h"
#include "core/pose/mirror.h"
#include "formats/bvh/clip_file.h"

namespace dance {
namespace {

constexpr double kRootTremble_m_per_deg = 0.006;
constexpr std::size_t kFewestPoses = 30;

// leftHand <-> rightHand
std::size_t other_side(std::size_t bone) {
  std::string name(kBones[bone].name);
  if (name.rfind("left", 0) == 0)
    name.replace(0, 4, "right");
  else if (name.rfind("right", 0) == 0)
    name.replace(0, 5, "left");
  return index_of(find_bone(name).value_or(static_cast<Bone>(bone)));
}

void stamp_poses(PredictTake& take) {
  for (std::size_t i = 0; i < take.poses.size(); ++i) {
    Pose& pose = take.poses[i];
    normalize(pose);
    pose.sequence = static_cast<std::uint32_t>(i);
    pose.capture_time = MonoTime() + Duration::seconds(1.0 + static_cast<double>(i) / take.hz);
  }
}

}  // namespace

Result<PredictTake> load_predict_take(const std::string& path, double hz) {
  DANCE_TRY(const LoadedClip loaded, load_clip(path));
  PredictTake take;
  take.name = std::filesystem::path(path).filename().string();
  take.skeleton = loaded.clip.skeleton;
  take.hz = hz;
  const auto count = static_cast<std::size_t>(loaded.clip.length().as_seconds() * hz + 1e-3);
  if (count < kFewestPoses)
    return fail(path + ": is too short, at least " + std::to_string(kFewestPoses) +
                " frames are needed");
  for (std::size_t i = 0; i < count; ++i) {
    Pose pose;
    sample_clip(loaded.clip, Duration::seconds(static_cast<double>(i) / hz + 1e-7), ClipEnd::kHold,
                pose);
    take.poses.push_back(pose);
  }
  stamp_poses(take);
  return take;
}

std::vector<Pose> trembling(const std::vector<Pose>& poses, double sd_deg, Random& random) {
  std::vector<Pose> out = poses;
  if (sd_deg <= 0.0) return out;
  const double sd_rad = sd_deg * static_cast<double>(EIGEN_PI) / 180.0;
  const auto vector = [&](double sd) {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    return Eigen::Vector3f(Eigen::Vector3d(x * sd, y * sd, z * sd).cast<float>());
  };
  for (Pose& pose : out) {
    for (auto& q : pose.R_PB) q = (q * exp_rotation(vector(sd_rad))).normalized();
    pose.p_WH_m += vector(sd_deg * kRootTremble_m_per_deg);
  }
  return out;
}

PredictTake mirrored(const PredictTake& take) {
  PredictTake out = take;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    out.skeleton.offset_m[b] = mirrored(take.skeleton.offset_m[other_side(b)]);
  }
  for (std::size_t i = 0; i < take.poses.size(); ++i) {
    const Pose& from = take.poses[i];
    Pose& to = out.poses[i];
    to.presence = 0;
    for (std::size_t b = 0; b < kBoneCount; ++b) {
      const std::size_t o = other_side(b);
      to.R_PB[b] = mirrored(from.R_PB[o]);
      to.presence |= (from.presence >> o & 1u) << b;
    }
    to.p_WH_m = mirrored(to.p_WH_m);
  }
  return out;
}

}  // namespace dance

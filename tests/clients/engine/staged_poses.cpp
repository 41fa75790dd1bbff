#include "tests/clients/engine/staged_poses.h"

#include <algorithm>
#include <sstream>

namespace dance {
namespace {

// The places of a client's axes in W, by what those axes are said to be.
Eigen::Vector3d in_stage(const Eigen::Vector3d& at, dance_axes axes) {
  switch (axes) {
    case DANCE_AXES_GLTF:
      return at;
    case DANCE_AXES_UNITY:  // left-handed: the left hand is at -X
      return {-at.x(), at.y(), at.z()};
    case DANCE_AXES_UNREAL:  // centimetres, +X forward, +Y right, +Z up
      return Eigen::Vector3d(-at.y(), at.z(), at.x()) / 100.0;
    case DANCE_AXES_BLENDER:  // -Y forward, +Z up
      return {at.x(), at.z(), -at.y()};
  }
  return at;
}

}  // namespace

StagedPoses::StagedPoses(Bus& bus) {
  bus.subscribe<TimedSkeleton>(
      Where::kStage, [this](const Channel& channel, const TimedSkeleton& timed, MonoTime) {
        skeletons_[std::string(channel.guest().view())] = timed.skeleton;
      });
  bus.subscribe<Pose>(Where::kStage, [this](const Channel& channel, const Pose& pose, MonoTime) {
    const std::string guest(channel.guest().view());
    const auto skeleton = skeletons_.find(guest);
    if (skeleton == skeletons_.end()) return;
    BodyFrames frames;
    forward_kinematics(skeleton->second, pose, frames);
    staged_[{guest, pose.sequence}] = frames.p_WB_m;
    newest_[guest] = pose.sequence;
  });
}

void StagedPoses::mark() { marked_ = newest_; }

bool StagedPoses::compare_pose(const std::string& line, dance_axes axes,
                               StagedPoseComparison& comparison) const {
  std::istringstream words(line);
  std::string word, guest;
  std::uint32_t sequence = 0;
  words >> word >> guest >> sequence;
  std::array<Eigen::Vector3d, kBoneCount> places;
  for (Eigen::Vector3d& place : places) words >> place.x() >> place.y() >> place.z();
  if (!words || (words >> word)) return false;
  const auto staged = staged_.find({guest, sequence});
  if (staged == staged_.end()) {
    ++comparison.unheard;
    return true;
  }
  ++comparison.poses[guest];
  const auto marked = marked_.find(guest);
  if (marked != marked_.end() && static_cast<std::int32_t>(sequence - marked->second) > 0)
    ++comparison.poses_after[guest];
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const double away_mm =
        (in_stage(places[b], axes) - staged->second[b].cast<double>()).norm() * 1000.0;
    comparison.furthest_mm = std::max(comparison.furthest_mm, away_mm);
  }
  return true;
}

StagedPoseComparison StagedPoses::compare(const std::string& client_output, dance_axes axes) const {
  StagedPoseComparison comparison;
  std::istringstream lines(client_output);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("pose ")) {
      if (!compare_pose(line, axes, comparison)) ++comparison.unreadable;
    } else if (line.starts_with("counters ")) {
      std::istringstream words(line.substr(9));
      for (auto& counter : comparison.counters) words >> counter;
      comparison.has_counters = static_cast<bool>(words);
    } else if (line.starts_with("collections ")) {
      comparison.collections = std::stoi(line.substr(12));
    }
  }
  return comparison;
}

}  // namespace dance

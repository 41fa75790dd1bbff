// The bones of the VMC protocol: the 55 of Unity's HumanBodyBones, under the names and in the order
// that Unity has them, and which of ours they are.
//
// Unity, and VRM 0 with it, call the thumb's bones Proximal, Intermediate and Distal; VRM 1 and we
// call the same three Metacarpal, Proximal and Distal. "LeftThumbProximal" alone does not tell
// which it is: VmcThumbs does.
//
// Units/frames: none.
// Ownership:    constants.
// Threads:      constants only.
// Failure:      find_vmc_bone() returns nullopt for an unknown name.
// Source:       VMC protocol specification; Unity's HumanBodyBones; VRM 0.0 and 1.0, humanoid.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/pose/bone.h"

namespace dance {

// A dancer's bones in one row: the body's, then the fingers'.
constexpr std::size_t kDancerBoneCount = kBoneCount + kFingerBoneCount;
constexpr std::size_t kVmcBoneCount = kDancerBoneCount + 3;

enum class VmcFace : std::uint8_t { kLeftEye, kRightEye, kJaw };

struct VmcBone {
  const char* name;
  std::int8_t bone;  // in a dancer's row; below 0 of the face, which our dancers do not have
  VmcFace face = VmcFace::kJaw;

  bool is_body() const { return bone >= 0 && static_cast<std::size_t>(bone) < kBoneCount; }
  bool is_finger() const { return static_cast<std::size_t>(bone) >= kBoneCount && bone >= 0; }
  std::size_t finger() const { return static_cast<std::size_t>(bone) - kBoneCount; }
};

extern const std::array<VmcBone, kVmcBoneCount> kVmcBones;

enum class VmcThumbs : std::uint8_t { kUnity, kVrm1 };
// Which of the two a name belongs to, where it tells.
std::optional<VmcThumbs> thumbs_told_by(std::string_view name);
// In a dancer's row; -1 of the face. Unity's names, and VRM's, which begin with a small letter.
std::optional<int> find_vmc_bone(std::string_view name, VmcThumbs thumbs);

}  // namespace dance

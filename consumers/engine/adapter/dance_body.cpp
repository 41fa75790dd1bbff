// The functions of dance_adapter.h that need no house: names, parents, the clock, kinematics.

#include <Eigen/Geometry>
#include <array>

#include "consumers/engine/adapter/caller_struct.h"
#include "consumers/engine/dance_adapter.h"
#include "core/net/mono_clock.h"
#include "core/pose/bone.h"

using dance::kBoneCount;
using dance::kBones;
using dance::kFingerBoneCount;
using dance::kFingerBones;
using Eigen::Quaternionf;
using Eigen::Vector3f;

uint32_t dance_adapter_abi(void) { return DANCE_ADAPTER_ABI; }

int64_t dance_adapter_now_ns(void) { return dance::mono_now().since_zero_ns(); }

// The names are literals, which end with a zero.
const char* dance_bone_name(uint32_t bone) {
  return bone < kBoneCount ? kBones[bone].name.data() : nullptr;
}

int32_t dance_bone_parent(uint32_t bone) { return bone < kBoneCount ? kBones[bone].parent : -1; }

const char* dance_finger_bone_name(uint32_t bone) {
  return bone < kFingerBoneCount ? kFingerBones[bone].name.data() : nullptr;
}

int32_t dance_finger_bone_parent(uint32_t bone) {
  return bone < kFingerBoneCount ? kFingerBones[bone].parent : -1;
}

const char* dance_status_text(dance_status status) {
  switch (status) {
    case DANCE_OK:
      return "fine";
    case DANCE_NO_HOUSE:
      return "no house of that name is running: start `dance listen --to engine`, or a house whose "
             "session has [[listen]] to = \"engine\"";
    case DANCE_NO_GUEST:
      return "no dancer is in that slot";
    case DANCE_NO_DATA:
      return "the dancer has none of this";
    case DANCE_BUSY:
      return "overtaken by the writer: use what you had";
    case DANCE_WRONG_VERSION:
      return "the house is of another version: update it or libdance_adapter";
    case DANCE_DAMAGED:
      return "what is in the memory is not a house's";
    case DANCE_BAD_ARGUMENT:
      return "wrong argument: NULL, a slot out of range, struct_size not set, or an unfit name";
    case DANCE_INVALID:
      return "the pose is not finite, or its rotations are not of length 1";
  }
  return "unknown status";
}

// Forward kinematics is the same in all axes: p' = M p and q' = (det M · M v, w) keep products.
dance_status dance_world_of(const dance_skeleton* skeleton, const dance_pose* pose,
                            dance_world* world) {
  using dance::engine::fits;
  if (!fits(skeleton) || !fits(pose) || !fits(world)) return DANCE_BAD_ARGUMENT;
  std::array<Quaternionf, kBoneCount> R_WB;
  std::array<Vector3f, kBoneCount> p_WB;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const Quaternionf R_PB(Eigen::Vector4f(pose->rotation[b]));
    if (b == 0) {
      R_WB[b] = R_PB;
      p_WB[b] = Vector3f(pose->hips_position);
    } else {
      const auto parent = static_cast<std::size_t>(kBones[b].parent);
      R_WB[b] = R_WB[parent] * R_PB;
      p_WB[b] = p_WB[parent] + R_WB[parent] * Vector3f(skeleton->offset[b]);
    }
    Vector3f::Map(world->position[b]) = p_WB[b];
    Eigen::Vector4f::Map(world->rotation[b]) = R_WB[b].coeffs();
  }
  for (std::size_t t = 0; t < dance::kTipCount; ++t) {
    const std::size_t b = index_of(dance::kTipBones[t]);
    Vector3f::Map(world->tip[t]) = p_WB[b] + R_WB[b] * Vector3f(skeleton->tip[t]);
  }
  dance::engine::clear_unknown(world);
  return DANCE_OK;
}

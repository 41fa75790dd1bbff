// The bones of the canonical skeleton: 22 body bones of the VRM 1.0 humanoid in a fixed order
// (one-to-one with the 22 body joints of SMPL), and 30 finger bones. Order, names and parents are
// part of every wire and file format.
//
// Threads: constants only.
// Failure: find_bone() returns nullopt for an unknown name.
// Source:  VRM 1.0 specification, humanoid bones.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace dance {

enum class Bone : std::uint8_t {
  kHips,
  kSpine,
  kChest,
  kUpperChest,
  kNeck,
  kHead,
  kLeftShoulder,
  kLeftUpperArm,
  kLeftLowerArm,
  kLeftHand,
  kRightShoulder,
  kRightUpperArm,
  kRightLowerArm,
  kRightHand,
  kLeftUpperLeg,
  kLeftLowerLeg,
  kLeftFoot,
  kLeftToes,
  kRightUpperLeg,
  kRightLowerLeg,
  kRightFoot,
  kRightToes,
};
constexpr std::size_t kBoneCount = 22;
constexpr std::size_t kFingerBoneCount = 30;

constexpr std::size_t index_of(Bone bone) { return static_cast<std::size_t>(bone); }

struct BoneInfo {
  std::string_view name;  // as VRM 1.0 writes it
  std::int8_t parent;     // index; -1 for the hips; always smaller than the bone's own
};

constexpr std::array<BoneInfo, kBoneCount> kBones{{
    {"hips", -1},          {"spine", 0},      {"chest", 1},         {"upperChest", 2},
    {"neck", 3},           {"head", 4},       {"leftShoulder", 3},  {"leftUpperArm", 6},
    {"leftLowerArm", 7},   {"leftHand", 8},   {"rightShoulder", 3}, {"rightUpperArm", 10},
    {"rightLowerArm", 11}, {"rightHand", 12}, {"leftUpperLeg", 0},  {"leftLowerLeg", 14},
    {"leftFoot", 15},      {"leftToes", 16},  {"rightUpperLeg", 0}, {"rightLowerLeg", 18},
    {"rightFoot", 19},     {"rightToes", 20},
}};

// The five ends of the body: where its last bones end. Order of Skeleton::tip_m and of skeleton_t.
enum class Tip : std::uint8_t { kHead, kLeftHand, kRightHand, kLeftToes, kRightToes };
constexpr std::size_t kTipCount = 5;
constexpr std::array<Bone, kTipCount> kTipBones{Bone::kHead, Bone::kLeftHand, Bone::kRightHand,
                                                Bone::kLeftToes, Bone::kRightToes};

// Finger bones, left hand then right, thumb to little; parents are finger bones, or -1 for that
// side's hand.
constexpr std::array<BoneInfo, kFingerBoneCount> kFingerBones{{
    {"leftThumbMetacarpal", -1},  {"leftThumbProximal", 0},        {"leftThumbDistal", 1},
    {"leftIndexProximal", -1},    {"leftIndexIntermediate", 3},    {"leftIndexDistal", 4},
    {"leftMiddleProximal", -1},   {"leftMiddleIntermediate", 6},   {"leftMiddleDistal", 7},
    {"leftRingProximal", -1},     {"leftRingIntermediate", 9},     {"leftRingDistal", 10},
    {"leftLittleProximal", -1},   {"leftLittleIntermediate", 12},  {"leftLittleDistal", 13},
    {"rightThumbMetacarpal", -1}, {"rightThumbProximal", 15},      {"rightThumbDistal", 16},
    {"rightIndexProximal", -1},   {"rightIndexIntermediate", 18},  {"rightIndexDistal", 19},
    {"rightMiddleProximal", -1},  {"rightMiddleIntermediate", 21}, {"rightMiddleDistal", 22},
    {"rightRingProximal", -1},    {"rightRingIntermediate", 24},   {"rightRingDistal", 25},
    {"rightLittleProximal", -1},  {"rightLittleIntermediate", 27}, {"rightLittleDistal", 28},
}};

constexpr std::optional<Bone> find_bone(std::string_view name) {
  for (std::size_t i = 0; i < kBoneCount; ++i)
    if (kBones[i].name == name) return static_cast<Bone>(i);
  return std::nullopt;
}

}  // namespace dance

#include "formats/osc/vmc_bones.h"

namespace dance {
namespace {

char capital(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

// VRM's names begin with a small letter, Unity's with a capital one.
bool is_same_bone(std::string_view a, std::string_view b) {
  return !a.empty() && !b.empty() && capital(a[0]) == capital(b[0]) && a.substr(1) == b.substr(1);
}

std::optional<int> find_finger_of_vrm1(std::string_view name) {
  for (std::size_t i = 0; i < kFingerBoneCount; ++i)
    if (is_same_bone(name, kFingerBones[i].name)) return static_cast<int>(kBoneCount + i);
  return std::nullopt;
}

}  // namespace

// In Unity's order; the number is the place in a dancer's row.
const std::array<VmcBone, kVmcBoneCount> kVmcBones{{
    {"Hips", 0},
    {"LeftUpperLeg", 14},
    {"RightUpperLeg", 18},
    {"LeftLowerLeg", 15},
    {"RightLowerLeg", 19},
    {"LeftFoot", 16},
    {"RightFoot", 20},
    {"Spine", 1},
    {"Chest", 2},
    {"Neck", 4},
    {"Head", 5},
    {"LeftShoulder", 6},
    {"RightShoulder", 10},
    {"LeftUpperArm", 7},
    {"RightUpperArm", 11},
    {"LeftLowerArm", 8},
    {"RightLowerArm", 12},
    {"LeftHand", 9},
    {"RightHand", 13},
    {"LeftToes", 17},
    {"RightToes", 21},
    {"LeftEye", -1, VmcFace::kLeftEye},
    {"RightEye", -1, VmcFace::kRightEye},
    {"Jaw", -1, VmcFace::kJaw},
    {"LeftThumbProximal", 22},
    {"LeftThumbIntermediate", 23},
    {"LeftThumbDistal", 24},
    {"LeftIndexProximal", 25},
    {"LeftIndexIntermediate", 26},
    {"LeftIndexDistal", 27},
    {"LeftMiddleProximal", 28},
    {"LeftMiddleIntermediate", 29},
    {"LeftMiddleDistal", 30},
    {"LeftRingProximal", 31},
    {"LeftRingIntermediate", 32},
    {"LeftRingDistal", 33},
    {"LeftLittleProximal", 34},
    {"LeftLittleIntermediate", 35},
    {"LeftLittleDistal", 36},
    {"RightThumbProximal", 37},
    {"RightThumbIntermediate", 38},
    {"RightThumbDistal", 39},
    {"RightIndexProximal", 40},
    {"RightIndexIntermediate", 41},
    {"RightIndexDistal", 42},
    {"RightMiddleProximal", 43},
    {"RightMiddleIntermediate", 44},
    {"RightMiddleDistal", 45},
    {"RightRingProximal", 46},
    {"RightRingIntermediate", 47},
    {"RightRingDistal", 48},
    {"RightLittleProximal", 49},
    {"RightLittleIntermediate", 50},
    {"RightLittleDistal", 51},
    {"UpperChest", 3},
}};

std::optional<VmcThumbs> thumbs_told_by(std::string_view name) {
  if (name.find("Thumb") == std::string_view::npos) return std::nullopt;
  if (name.ends_with("Metacarpal")) return VmcThumbs::kVrm1;
  if (name.ends_with("Intermediate")) return VmcThumbs::kUnity;
  return std::nullopt;
}

std::optional<int> find_vmc_bone(std::string_view name, VmcThumbs thumbs) {
  if (thumbs == VmcThumbs::kVrm1)
    if (const auto finger = find_finger_of_vrm1(name)) return finger;
  for (const VmcBone& bone : kVmcBones)
    if (is_same_bone(name, bone.name)) return bone.bone;
  return std::nullopt;
}

}  // namespace dance

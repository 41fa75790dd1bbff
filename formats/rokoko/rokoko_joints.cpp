#include <algorithm>

#include "formats/rokoko/rokoko_frame.h"

namespace dance {
namespace {

constexpr float kHalf = 0.5f;
constexpr float kSqrtHalf = 0.70710678f;

struct Rotation {
  float w, x, y, z;
};

struct Joint {
  std::string_view name;
  Rotation t_pose;
  std::optional<Bone> bone;
};

constexpr Rotation kUprightRest{0, 0, 0, 1};
constexpr Rotation kLeftArmRest{kHalf, kHalf, kHalf, -kHalf};
constexpr Rotation kRightArmRest{kHalf, kHalf, -kHalf, kHalf};
constexpr Rotation kLeftLegRest{kSqrtHalf, 0, kSqrtHalf, 0};
constexpr Rotation kRightLegRest{kSqrtHalf, 0, -kSqrtHalf, 0};
constexpr Rotation kLeftFootRest{0, 0, kSqrtHalf, -kSqrtHalf};
constexpr Rotation kRightFootRest{0, 0, -kSqrtHalf, kSqrtHalf};
// A thumb's first joint points 30° forward and is rolled by 45° like the others.
constexpr Rotation kLeftThumb0Rest{0.09229596f, 0.56098553f, 0.70105738f, -0.43045933f};
constexpr Rotation kRightThumb0Rest{0.09229596f, 0.56098553f, -0.70105738f, 0.43045933f};
constexpr Rotation kLeftThumbRest{0.27059805f, 0.65328148f, 0.65328148f, -0.27059805f};
constexpr Rotation kRightThumbRest{0.27059805f, 0.65328148f, -0.65328148f, 0.27059805f};

constexpr std::array<Joint, kRokokoJointCount> kJoints{{
    {"hip", {1, 0, 0, 0}, Bone::kHips},
    {"spine", kUprightRest, Bone::kSpine},
    {"chest", kUprightRest, Bone::kUpperChest},
    {"neck", kUprightRest, Bone::kNeck},
    {"head", kUprightRest, Bone::kHead},
    {"leftShoulder", {kSqrtHalf, 0, 0, -kSqrtHalf}, Bone::kLeftShoulder},
    {"leftUpperArm", kLeftArmRest, Bone::kLeftUpperArm},
    {"leftLowerArm", kLeftArmRest, Bone::kLeftLowerArm},
    {"leftHand", kLeftArmRest, Bone::kLeftHand},
    {"rightShoulder", {kSqrtHalf, 0, 0, kSqrtHalf}, Bone::kRightShoulder},
    {"rightUpperArm", kRightArmRest, Bone::kRightUpperArm},
    {"rightLowerArm", kRightArmRest, Bone::kRightLowerArm},
    {"rightHand", kRightArmRest, Bone::kRightHand},
    {"leftUpLeg", kLeftLegRest, Bone::kLeftUpperLeg},
    {"leftLeg", kLeftLegRest, Bone::kLeftLowerLeg},
    {"leftFoot", kLeftFootRest, Bone::kLeftFoot},
    {"leftToe", kLeftFootRest, Bone::kLeftToes},
    {"leftToeEnd", kLeftFootRest, std::nullopt},
    {"rightUpLeg", kRightLegRest, Bone::kRightUpperLeg},
    {"rightLeg", kRightLegRest, Bone::kRightLowerLeg},
    {"rightFoot", kRightFootRest, Bone::kRightFoot},
    {"rightToe", kRightFootRest, Bone::kRightToes},
    {"rightToeEnd", kRightFootRest, std::nullopt},
    {"leftThumbProximal", kLeftThumb0Rest, {}},
    {"leftThumbMedial", kLeftThumbRest, {}},
    {"leftThumbDistal", kLeftThumbRest, {}},
    {"leftThumbTip", kLeftThumbRest, {}},
    {"leftIndexProximal", kLeftArmRest, {}},
    {"leftIndexMedial", kLeftArmRest, {}},
    {"leftIndexDistal", kLeftArmRest, {}},
    {"leftIndexTip", kLeftArmRest, {}},
    {"leftMiddleProximal", kLeftArmRest, {}},
    {"leftMiddleMedial", kLeftArmRest, {}},
    {"leftMiddleDistal", kLeftArmRest, {}},
    {"leftMiddleTip", kLeftArmRest, {}},
    {"leftRingProximal", kLeftArmRest, {}},
    {"leftRingMedial", kLeftArmRest, {}},
    {"leftRingDistal", kLeftArmRest, {}},
    {"leftRingTip", kLeftArmRest, {}},
    {"leftLittleProximal", kLeftArmRest, {}},
    {"leftLittleMedial", kLeftArmRest, {}},
    {"leftLittleDistal", kLeftArmRest, {}},
    {"leftLittleTip", kLeftArmRest, {}},
    {"rightThumbProximal", kRightThumb0Rest, {}},
    {"rightThumbMedial", kRightThumbRest, {}},
    {"rightThumbDistal", kRightThumbRest, {}},
    {"rightThumbTip", kRightThumbRest, {}},
    {"rightIndexProximal", kRightArmRest, {}},
    {"rightIndexMedial", kRightArmRest, {}},
    {"rightIndexDistal", kRightArmRest, {}},
    {"rightIndexTip", kRightArmRest, {}},
    {"rightMiddleProximal", kRightArmRest, {}},
    {"rightMiddleMedial", kRightArmRest, {}},
    {"rightMiddleDistal", kRightArmRest, {}},
    {"rightMiddleTip", kRightArmRest, {}},
    {"rightRingProximal", kRightArmRest, {}},
    {"rightRingMedial", kRightArmRest, {}},
    {"rightRingDistal", kRightArmRest, {}},
    {"rightRingTip", kRightArmRest, {}},
    {"rightLittleProximal", kRightArmRest, {}},
    {"rightLittleMedial", kRightArmRest, {}},
    {"rightLittleDistal", kRightArmRest, {}},
    {"rightLittleTip", kRightArmRest, {}},
}};

}  // namespace

std::string_view rokoko_joint_name(std::size_t joint) { return kJoints.at(joint).name; }

std::optional<std::size_t> find_rokoko_joint(std::string_view name) {
  const auto found = std::find_if(kJoints.begin(), kJoints.end(),
                                  [&](const Joint& joint) { return joint.name == name; });
  if (found == kJoints.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kJoints.begin());
}

Eigen::Quaternionf rokoko_t_pose(std::size_t joint) {
  const Rotation& r = kJoints.at(joint).t_pose;
  return Eigen::Quaternionf(r.w, r.x, r.y, r.z).normalized();
}

std::optional<Bone> bone_of(RokokoBody joint) { return kJoints[index_of(joint)].bone; }

}  // namespace dance

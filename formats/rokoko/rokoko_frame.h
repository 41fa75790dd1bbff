// RokokoFrame: what a datagram of Rokoko Studio's live stream in JSON v3 carries: the actors of a
// scene with the joints of their bodies. Faces, props and characters are not kept.
//
// Units/frames: Studio's space: left-handed, Y up, Z forward, metres; a joint's rotation is global.
//               In T-pose a joint has the rotation rokoko_t_pose(), in which -Y points along the
//               bone. rokoko_to_W() and rokoko_from_W() lead to and from W, its mirror image.
// Ownership:    plain values without heap; about 30 kB.
// Threads:      constants and plain values.
// Failure:      none.
// Source:       the joints' names and their T-pose as the public plugins of Rokoko for Blender
//               (core/animation_lists.py) and Unity (ActorNewton.cs) have them; the stream's keys
//               from the article "Custom Streaming" of Rokoko's help pages.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/base/fixed_list.h"
#include "core/base/fixed_string.h"
#include "core/pose/bone.h"
#include "core/pose/mirror.h"

namespace dance {

// Of a body, in the order in which Studio sends them, then the fingers: left hand, then right, from
// thumb to little finger, each with four joints, the last of which is its tip.
constexpr std::size_t kRokokoBodyJointCount = 23;
constexpr std::size_t kRokokoFingerJointCount = 40;
constexpr std::size_t kRokokoJointCount = kRokokoBodyJointCount + kRokokoFingerJointCount;

// The body's joints, the first of all.
enum class RokokoBody : std::uint8_t {
  kHip,
  kSpine,
  kChest,
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
  kLeftUpLeg,
  kLeftLowLeg,
  kLeftFoot,
  kLeftToe,
  kLeftToeEnd,
  kRightUpLeg,
  kRightLowLeg,
  kRightFoot,
  kRightToe,
  kRightToeEnd,
};
constexpr std::size_t index_of(RokokoBody joint) { return static_cast<std::size_t>(joint); }
// Joint 0 to 3 of finger 0 to 9.
constexpr std::size_t rokoko_finger_joint(std::size_t finger, std::size_t joint) {
  return kRokokoBodyJointCount + 4 * finger + joint;
}

std::string_view rokoko_joint_name(std::size_t joint);
std::optional<std::size_t> find_rokoko_joint(std::string_view name);
// In Studio's space.
Eigen::Quaternionf rokoko_t_pose(std::size_t joint);
// The bone that begins at a joint of the body; none for the ends of the toes. Studio's chest is the
// upper chest, which neck and shoulders hang on.
std::optional<Bone> bone_of(RokokoBody joint);

struct RokokoJoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  Eigen::Quaternionf rotation = Eigen::Quaternionf::Identity();
};

struct RokokoActor {
  static constexpr std::size_t kLongestName = 64;

  FixedString<kLongestName> name;
  bool has_body = false;
  bool has_left_glove = false;
  bool has_right_glove = false;
  bool has_face = false;
  float total_height_m = 0.0f;  // 0: not said
  float hip_height_m = 0.0f;
  std::array<std::uint8_t, 3> color{255, 255, 255};
  std::array<RokokoJoint, kRokokoJointCount> joints;
  std::bitset<kRokokoJointCount> present;

  bool has(RokokoBody joint) const { return present[index_of(joint)]; }
  const RokokoJoint& joint(RokokoBody which) const { return joints[index_of(which)]; }
};

struct RokokoFrame {
  static constexpr std::size_t kMostActors = 16;

  double fps = 60.0;
  double timestamp_s = 0.0;
  FixedList<RokokoActor, kMostActors> actors;
};

// A joint's rotation away from the T-pose, in W, and back.
inline Eigen::Quaternionf rokoko_to_W(std::size_t joint, const Eigen::Quaternionf& rotation) {
  return mirrored(rotation * rokoko_t_pose(joint).conjugate());
}
inline Eigen::Quaternionf rokoko_from_W(std::size_t joint, const Eigen::Quaternionf& R_WB) {
  return mirrored(R_WB) * rokoko_t_pose(joint);
}

}  // namespace dance

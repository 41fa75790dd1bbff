// AvatarShape: what retargeting has to know about a model, worked out once for each: where its
// nodes are at rest, which of them are turned by a bone and which only follow, where its soles and
// palms are, which nodes share a limb's twist, which swing.
//
// Units/frames: M is the model at rest: metres, +Y up, facing +Z. A driver is a node that is
//               placed and turned of its own; every other node follows the nearest one above it.
// Ownership:    plain values; holds no reference to the model.
// Threads:      none inside; const use from any.
// Failure:      none for a sound model (is_sound()); what cannot be measured is estimated from the
//               figure's height.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "formats/avatar/avatar_model.h"
#include "viewer/figure/rig/face_map.h"

namespace dance {

constexpr std::size_t kFirstFingerDriver = kBoneCount;
constexpr std::size_t kFirstFreeDriver = kBoneCount + kFingerBoneCount;

// A node between the ends of a limb's bone that takes a share of the twist.
struct TwistNode {
  std::size_t driver = 0;
  Bone bone = Bone::kHips;  // of which it is a part
  // How many of the equal steps of twist between the bone's two ends lie before it.
  std::uint8_t step = 1;
  std::uint8_t steps = 2;
};

// A node that swings; see viewer/figure/spring_chain.h.
struct SwingNode {
  std::size_t driver = 0;
  std::size_t parent = 0;                              // driver
  Eigen::Vector3f tail_M_m = Eigen::Vector3f::Zero();  // from the node
  float radius_m = 0.0f;
  float stiffness = 1.0f;
  float drag = 0.4f;
  Eigen::Vector3f gravity = Eigen::Vector3f::Zero();
  int centre = -1;  // driver
  std::uint32_t first_collider = 0;
  std::uint32_t collider_count = 0;
};

struct SwingCollider {
  std::size_t driver = 0;
  Eigen::Vector3f centre_M_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f tail_M_m = Eigen::Vector3f::Zero();
  float radius_m = 0.0f;
};

// The lowest part of a foot's mesh at rest.
struct SoleShape {
  float floor_m = 0.0f;  // Y
  float heel_m = 0.0f;   // Z of its ends
  float tip_m = 0.0f;
  float inner_m = 0.0f;  // X of its sides
  float outer_m = 0.0f;
};

// The vertices of a foot, and of its toes, that can be the lowest when it is pitched and rolled.
struct SoleHull {
  static constexpr std::size_t kMost = 32;
  std::array<Eigen::Vector3f, kMost> foot_m;
  std::array<Eigen::Vector3f, kMost> toes_m;
  std::size_t foot_count = 0;
  std::size_t toes_count = 0;
};

struct AvatarShape {
  // What a joint's matrix is made of: its driver, and the mesh at rest seen from the driver.
  struct Follower {
    std::uint32_t driver = 0;
    Eigen::Matrix3f linear;
    Eigen::Vector3f place_m;
  };
  std::array<bool, kBoneCount> has_bone{};
  std::array<bool, kFingerBoneCount> has_finger{};
  std::vector<Eigen::Vector3f> drivers_M_m;  // bones, fingers, then twist and swing nodes
  std::vector<std::size_t> leaders;          // of each driver from kFirstFreeDriver on
  std::vector<Follower> followers;           // of each AvatarJoint
  std::vector<TwistNode> twists;
  std::vector<SwingNode>
      swings;  // parents first; bounded, with their contacts, as AvatarModel says
  std::vector<SwingCollider> colliders;
  std::array<SoleShape, 2> soles;
  std::array<SoleHull, 2> hulls;                 // in M
  std::array<Eigen::Vector3f, 2> hand_ends_M_m;  // where the middle finger begins, or would
  float height_m = 1.7f;
  float crown_m = 0.2f;  // from the head's joint up to the highest of its mesh, at rest
  Eigen::Vector3f eyes_M_m = Eigen::Vector3f::Zero();  // between the eyes
  std::array<int, 2> eyes{-1, -1};                     // drivers; -1 where no node turns the eye
  FaceMap face;

  // True if a face moves any part of the figure.
  bool has_face() const { return !face.is_empty() || eyes[0] >= 0 || eyes[1] >= 0; }
  const Eigen::Vector3f& at(Bone bone) const { return drivers_M_m[index_of(bone)]; }
  bool has(Bone bone) const { return has_bone[index_of(bone)]; }
};

AvatarShape shape_of(const AvatarModel& model);

}  // namespace dance

// AvatarModel: a human figure that can dance, as plain values: nodes, the vertices that
// follow them, materials with their pictures, morph targets, springs of hair and cloth. Read from
// GLB and VRM files, or made from a dancer's own proportions (the mannequin).
//
// Units/frames: metres, +Y up; the figure at rest faces +Z, whatever the file had. A node's rest
//               transform is from its own axes to its parent's. Vertices are in the axes of their
//               mesh; AvatarJoint::node_from_mesh brings them to a joint's node at rest. Colours
//               are linear, pictures 8-bit sRGB.
// Ownership:    plain values; shared as std::shared_ptr<const AvatarModel> between threads.
// Threads:      none inside; const use from any.
// Failure:      is_sound() says whether every index is inside and every number finite; readers
//               return only sound models.
// Source:       Khronos glTF 2.0; VRM 1.0 (VRMC_vrm, VRMC_springBone, VRMC_materials_mtoon), 0.x.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/pose/bone.h"

namespace dance {

struct AvatarNode {
  std::string name;
  int parent = -1;  // smaller than the node's own index; -1 for a root
  Eigen::Vector3f translation_m = Eigen::Vector3f::Zero();
  Eigen::Quaternionf rotation = Eigen::Quaternionf::Identity();
  Eigen::Vector3f scale = Eigen::Vector3f::Ones();
};

// What vertices are tied to. What a file hangs on a node without a skin has that node as its joint.
struct AvatarJoint {
  int node = 0;
  Eigen::Affine3f node_from_mesh = Eigen::Affine3f::Identity();
};

struct AvatarVertex {
  Eigen::Vector3f place_m;
  Eigen::Vector3f normal;
  Eigen::Vector2f uv;
  std::array<std::uint16_t, 4> joints{};              // indices of AvatarModel::joints
  std::array<std::uint8_t, 4> weights{255, 0, 0, 0};  // of 255, which they add up to
};

struct AvatarPicture {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgba;  // rows from the top
};

enum class AlphaMode : std::uint8_t { kOpaque, kMask, kBlend };
enum class Shading : std::uint8_t { kLit, kToon, kUnlit };

struct AvatarMaterial {
  std::string name;
  Eigen::Vector4f base_colour = Eigen::Vector4f::Ones();
  int picture = -1;  // of the base colour; -1 = none
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5f;
  bool is_double_sided = false;
  float roughness = 0.8f;
  Eigen::Vector3f emission = Eigen::Vector3f::Zero();
  Shading shading = Shading::kLit;
  // Of kToon: the colour in shade, where shade begins (-1..1) and how sharp its edge is (0..1).
  Eigen::Vector3f shade_colour = Eigen::Vector3f::Constant(0.7f);
  float shade_shift = 0.0f;
  float shade_toony = 0.9f;
};

enum class FirstPerson : std::uint8_t { kAuto, kBoth, kThirdPersonOnly, kFirstPersonOnly };

// A range of AvatarModel::triangles with one material.
struct AvatarPart {
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
  std::uint32_t material = 0;
  FirstPerson first_person = FirstPerson::kAuto;
};

// By how much vertices move when the target is at 1.
struct AvatarMorph {
  std::string name;
  std::vector<std::uint32_t> vertices;
  std::vector<Eigen::Vector3f> places_m;  // differences, one for each of `vertices`
  std::vector<Eigen::Vector3f> normals;   // likewise, or none
};

// By VRM 1.0's names: happy, angry, sad, relaxed, surprised, aa, ih, ou, ee, oh, blink, …
struct AvatarExpression {
  struct Bind {
    std::uint32_t morph = 0;
    float weight = 1.0f;
  };
  std::string name;
  std::vector<Bind> binds;
};

// A ball, or a capsule where tail_m differs from centre_m, that swinging nodes stay out of; in the
// axes of its node.
struct AvatarCollider {
  int node = 0;
  Eigen::Vector3f centre_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f tail_m = Eigen::Vector3f::Zero();
  float radius_m = 0.0f;
};

// A chain of nodes that swing: hair, ribbons, skirts.
struct AvatarSpring {
  struct Joint {
    int node = 0;
    Eigen::Vector3f tail_m = Eigen::Vector3f::Zero();  // its end in its own axes
    float radius_m = 0.0f;
    float stiffness = 1.0f;
    float gravity = 0.0f;
    Eigen::Vector3f gravity_direction = -Eigen::Vector3f::UnitY();
    float drag = 0.4f;
  };
  std::vector<Joint> joints;  // each a descendant of the one before
  std::vector<std::uint32_t> colliders;
  int centre = -1;  // the node in whose axes it swings; -1 = W
};

// So much of a figure swings, as that costs time in every picture: nodes, and pairs of a node and a
// collider that it stays out of. What is beyond stays at rest.
constexpr std::size_t kMostSwingingNodes = 256;
constexpr std::size_t kMostSpringContacts = 4096;
constexpr std::size_t kMostSpringColliders = 32;  // of one spring

struct AvatarModel {
  std::string name;     // of its file; printable
  std::string licence;  // as the file tells it; printable, may be empty
  std::vector<AvatarNode> nodes;
  std::vector<AvatarJoint> joints;
  std::vector<AvatarVertex> vertices;
  std::vector<std::uint32_t> triangles;  // three vertices each, counter-clockwise from outside
  std::vector<AvatarPart> parts;
  std::vector<AvatarMaterial> materials;
  std::vector<AvatarPicture> pictures;
  std::vector<AvatarMorph> morphs;
  std::vector<AvatarExpression> expressions;
  std::vector<AvatarSpring> springs;
  std::vector<AvatarCollider> colliders;
  // The node of each bone; -1 where the figure has none. Hips, upper and lower limbs, hands, feet
  // and head are always there.
  std::array<int, kBoneCount> bones = all_missing<kBoneCount>();
  std::array<int, kFingerBoneCount> fingers = all_missing<kFingerBoneCount>();
  std::array<int, 2> eyes = all_missing<2>();  // left, right

  int node_of(Bone bone) const { return bones[index_of(bone)]; }

 private:
  template <std::size_t kCount>
  static constexpr std::array<int, kCount> all_missing() {
    std::array<int, kCount> nodes{};
    nodes.fill(-1);
    return nodes;
  }
};

// Bones without which a figure cannot dance.
constexpr std::array<Bone, 14> kNeededBones{
    Bone::kHips,          Bone::kHead,          Bone::kLeftUpperArm,  Bone::kLeftLowerArm,
    Bone::kLeftHand,      Bone::kRightUpperArm, Bone::kRightLowerArm, Bone::kRightHand,
    Bone::kLeftUpperLeg,  Bone::kLeftLowerLeg,  Bone::kLeftFoot,      Bone::kRightUpperLeg,
    Bone::kRightLowerLeg, Bone::kRightFoot};

bool is_sound(const AvatarModel& model);

}  // namespace dance

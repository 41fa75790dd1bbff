// An AvatarModel while it is made: the bones of the canonical skeleton as nodes, further nodes for
// what swings and for the eyes, and sheets of one material each.
//
// Units/frames: metres, W, T-pose; no node is rotated.
// Ownership:    owns the model until take().
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <string>
#include <vector>

#include "core/pose/skeleton.h"
#include "formats/avatar/make/sheet.h"

namespace dance {

class ModelBuilder {
 public:
  // Node and joint b is bone b, kBoneCount + f finger bone f.
  explicit ModelBuilder(const Skeleton& skeleton);

  // Gives the node, which is also a joint.
  int add_node(const std::string& name, int parent, const Eigen::Vector3f& place_m);
  const Eigen::Vector3f& place_m(int node) const {
    return places_m_[static_cast<std::size_t>(node)];
  }
  int add_material(AvatarMaterial material);
  // The same, seen from inside as well.
  int add_double_sided(int material);
  void make_double_sided(int material);
  int add_picture(AvatarPicture picture);
  void add_sheet(const Sheet& sheet, int material, FirstPerson first_person = FirstPerson::kAuto);
  std::uint32_t add_collider(Bone bone, const Eigen::Vector3f& a_m, const Eigen::Vector3f& b_m,
                             float radius_m);
  // The nodes of a chain, each the parent of the next; the last one only marks the end.
  struct Swing {
    float stiffness = 1.0f;
    float gravity = 0.0f;
    float drag = 0.4f;
    float radius_m = 0.01f;
  };
  void add_spring(const std::vector<int>& chain, const Swing& swing,
                  std::vector<std::uint32_t> colliders);
  void set_eyes(int left, int right) { model_.eyes = {left, right}; }

  // Sets name and licence, and the expressions of the existing morphs.
  AvatarModel take(const std::string& name, const std::string& licence);

 private:
  std::uint32_t morph(const std::string& name);
  bool has_morph(const std::string& name) const;
  void add_expression(const std::string& name, const std::vector<std::string>& morphs);

  AvatarModel model_;
  std::vector<Eigen::Vector3f> places_m_;  // of the nodes, in W
};

}  // namespace dance

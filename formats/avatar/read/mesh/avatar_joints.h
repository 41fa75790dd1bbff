// The joints that vertices follow: those of all skins one after the other, each pair of node and
// matrix once, and the nodes of meshes without a skin.
//
// Units/frames: matrices from a mesh's axes to a node's.
// Ownership:    fills the model's joints.
// Threads:      none inside.
// Failure:      names the skin and what is wrong with it; too many joints are an error.
// Source:       glTF 2.0, 3.7.3 Skins: a missing inverse bind matrix is the identity.
#pragma once

#include <array>
#include <map>

#include "formats/avatar/read/avatar_source.h"

namespace dance {

class AvatarJoints {
 public:
  explicit AvatarJoints(AvatarSource& source) : source_(source) {}

  // Costs nothing, however many there are.
  Result<void> check_count(int skin) const;
  // The model's joint of a node without a skin.
  Result<std::uint16_t> of_node(int file_node);
  // The model's joints in the order of the skin's.
  Result<const std::vector<std::uint16_t>*> of_skin(int skin);

 private:
  using Key = std::pair<int, std::array<float, 12>>;

  Result<std::uint16_t> add(int node, const Eigen::Affine3f& node_from_mesh);
  Result<std::vector<std::uint16_t>> read_skin(int skin);

  AvatarSource& source_;
  std::map<Key, std::uint16_t> known_;
  std::map<int, std::vector<std::uint16_t>> skins_;
};

}  // namespace dance

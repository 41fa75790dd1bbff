#include "formats/avatar/read/mesh/avatar_joints.h"

#include <algorithm>

#include "formats/gltf/glb_accessor.h"

namespace dance {

Result<std::uint16_t> AvatarJoints::add(int node, const Eigen::Affine3f& node_from_mesh) {
  Key key{node, {}};
  const Eigen::Matrix<float, 3, 4> rows = node_from_mesh.affine();
  std::copy(rows.data(), rows.data() + rows.size(), key.second.begin());
  const auto found = known_.find(key);
  if (found != known_.end()) return found->second;
  auto& joints = source_.model.joints;
  if (joints.size() >= source_.limits.joints)
    return fail("more than " + std::to_string(source_.limits.joints) +
                " joints; export fewer bones");
  joints.push_back({node, node_from_mesh});
  return known_[key] = static_cast<std::uint16_t>(joints.size() - 1);
}

Result<std::uint16_t> AvatarJoints::of_node(int file_node) {
  return add(source_.model_node(file_node), Eigen::Affine3f::Identity());
}

Result<const std::vector<std::uint16_t>*> AvatarJoints::of_skin(int skin) {
  const auto known = skins_.find(skin);
  if (known != skins_.end()) return &known->second;
  DANCE_TRY(auto joints, read_skin(skin));
  return &(skins_[skin] = std::move(joints));
}

Result<void> AvatarJoints::check_count(int index) const {
  const std::string what = "skin " + std::to_string(index);
  if (index < 0 || static_cast<std::size_t>(index) >= source_.file.skins.size())
    return fail(what + " is not in the file");
  const std::size_t count = source_.file.skins[static_cast<std::size_t>(index)].joints.size();
  if (count == 0) return fail(what + " has no joints; bind its meshes to bones again");
  if (count > source_.limits.joints)
    return fail(what + " has " + std::to_string(count) + " joints, more than " +
                std::to_string(source_.limits.joints) + "; export fewer bones");
  return {};
}

Result<std::vector<std::uint16_t>> AvatarJoints::read_skin(int index) {
  const std::string what = "skin " + std::to_string(index);
  if (auto fits = check_count(index); !fits) return tl::make_unexpected(fits.error());
  const tinygltf::Skin& skin = source_.file.skins[static_cast<std::size_t>(index)];
  std::vector<float> matrices;
  if (skin.inverseBindMatrices >= 0) {
    DANCE_TRY(matrices, read_attribute(source_.file, skin.inverseBindMatrices, 16,
                                       source_.limits.nodes * 16));
    if (matrices.size() / 16 < skin.joints.size())
      return fail(what + " has fewer matrices than joints");
  }
  std::vector<std::uint16_t> joints;
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    const int node = skin.joints[j];
    if (node < 0 || static_cast<std::size_t>(node) >= source_.scene.nodes.size())
      return fail(what + " has a joint that is not in the file");
    Eigen::Affine3f node_from_mesh = Eigen::Affine3f::Identity();
    if (!matrices.empty())
      node_from_mesh.matrix().topRows<3>() =
          Eigen::Map<const Eigen::Matrix4f>(matrices.data() + 16 * j).topRows<3>();
    DANCE_TRY(const std::uint16_t joint, add(source_.model_node(node), node_from_mesh));
    joints.push_back(joint);
  }
  return joints;
}

}  // namespace dance

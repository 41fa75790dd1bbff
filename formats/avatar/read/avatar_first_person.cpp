#include "formats/avatar/read/avatar_first_person.h"

#include <string>

#include "formats/gltf/glb_json.h"

namespace dance {
namespace {

using tinygltf::Value;

FirstPerson flag_of(const std::string& text) {
  if (text == "both" || text == "Both") return FirstPerson::kBoth;
  if (text == "thirdPersonOnly" || text == "ThirdPersonOnly") return FirstPerson::kThirdPersonOnly;
  if (text == "firstPersonOnly" || text == "FirstPersonOnly") return FirstPerson::kFirstPersonOnly;
  return FirstPerson::kAuto;
}

const Value* annotations(const tinygltf::Model& file, const char* extension) {
  return member(member(extension_of(file.extensions, extension), "firstPerson"), "meshAnnotations");
}

}  // namespace

AvatarFirstPerson::AvatarFirstPerson(const tinygltf::Model& file) {
  const Value* of_nodes = annotations(file, "VRMC_vrm");
  for (std::size_t i = 0; i < length_of(of_nodes); ++i)
    if (const auto node = index_in(member(item(of_nodes, i), "node"), file.nodes.size()))
      of_node_[*node] = flag_of(text_of(member(item(of_nodes, i), "type")));
  const Value* of_meshes = annotations(file, "VRM");
  for (std::size_t i = 0; i < length_of(of_meshes); ++i)
    if (const auto mesh = index_in(member(item(of_meshes, i), "mesh"), file.meshes.size()))
      of_mesh_[*mesh] = flag_of(text_of(member(item(of_meshes, i), "firstPersonFlag")));
}

FirstPerson AvatarFirstPerson::of(int node, int mesh) const {
  if (const auto found = of_node_.find(node); found != of_node_.end()) return found->second;
  if (const auto found = of_mesh_.find(mesh); found != of_mesh_.end()) return found->second;
  return FirstPerson::kAuto;
}

}  // namespace dance

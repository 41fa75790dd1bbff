#include "formats/avatar/avatar_reader.h"

#include <algorithm>
#include <cmath>

#include "formats/avatar/read/avatar_bones.h"
#include "formats/avatar/read/avatar_expressions.h"
#include "formats/avatar/read/avatar_licence.h"
#include "formats/avatar/read/avatar_nodes.h"
#include "formats/avatar/read/avatar_source.h"
#include "formats/avatar/read/avatar_springs.h"
#include "formats/avatar/read/look/avatar_materials.h"
#include "formats/avatar/read/mesh/avatar_meshes.h"
#include "formats/gltf/glb_container.h"

namespace dance {
namespace {

constexpr double kFurthestVertex_m = 1e4;

// Packing of meshes that is not read.
constexpr std::string_view kPacked[] = {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                        "KHR_meshopt_compression"};

Result<void> check_extensions(const tinygltf::Model& file) {
  for (const std::string_view packed : kPacked)
    if (std::ranges::find(file.extensionsUsed, packed) != file.extensionsUsed.end())
      return fail("packed with " + std::string(packed) + "; export it without compression");
  return {};
}

GlbLimits container_limits(const AvatarLimits& limits) {
  GlbLimits out;
  out.file_bytes = limits.file_bytes;
  out.json_bytes = limits.file_bytes;  // a .gltf holds its data as text
  out.json_objects = limits.json_objects;
  out.nodes = limits.nodes;
  out.joints = limits.joints;
  return out;
}

// Where each vertex is at rest, by the joint that it follows most.
Result<void> check_vertices(const AvatarModel& model) {
  const auto rest = rest_transforms(model);
  std::vector<Eigen::Affine3d> joints;
  for (const AvatarJoint& joint : model.joints)
    joints.push_back(rest[static_cast<std::size_t>(joint.node)] *
                     joint.node_from_mesh.cast<double>());
  for (const AvatarVertex& vertex : model.vertices) {
    const Eigen::Vector3d place = joints[vertex.joints[0]] * vertex.place_m.cast<double>();
    if (!place.allFinite() || place.norm() > kFurthestVertex_m)
      return fail("a vertex is too far away; export in metres");
  }
  return {};
}

Result<void> read_figure(AvatarSource& source) {
  if (auto done = source.go_on(); !done) return done;
  if (auto done = read_nodes(source); !done) return done;
  if (auto done = read_bones(source); !done) return done;
  if (auto done = turn_to_front(source); !done) return done;
  DANCE_TRY(const auto uvs, read_materials(source));
  DANCE_TRY(const ReadMeshes meshes, read_meshes(source, uvs));
  if (auto done = check_vertices(source.model); !done) return done;
  if (auto done = source.go_on(); !done) return done;
  read_expressions(source, meshes.morphs);
  read_springs(source);
  return {};
}

}  // namespace

Result<ReadAvatar> read_avatar(std::span<const std::uint8_t> bytes, const AvatarLimits& limits,
                               std::string_view name, const AvatarStop& stop) {
  const GlbLimits of_container = container_limits(limits);
  DANCE_TRY(const tinygltf::Model file, unpacked_model(bytes, of_container));
  if (auto checked = check_extensions(file); !checked) return tl::make_unexpected(checked.error());
  DANCE_TRY(const GlbScene scene, checked_scene(file, of_container));
  ReadAvatar out;
  AvatarSource source{file,
                      scene,
                      limits,
                      out.model,
                      out.notes,
                      {},
                      Eigen::Quaterniond::Identity(),
                      limits.numbers,
                      limits.bytes,
                      limits.morph_moves,
                      limits.looks,
                      stop};
  if (auto done = read_figure(source); !done) return tl::make_unexpected(done.error());
  read_licence(source, name);
  if (out.model.parts.empty()) return fail("no mesh that hangs from the figure");
  if (!is_sound(out.model)) return fail("an avatar with broken numbers; export it again");
  return out;
}

}  // namespace dance

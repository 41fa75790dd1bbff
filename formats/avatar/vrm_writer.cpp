#include "formats/avatar/vrm_writer.h"

#include <algorithm>
#include <map>
#include <set>

#include "formats/avatar/vrm_extensions.h"
#include "formats/gltf/glb_container.h"
#include "formats/picture/png_writer.h"

namespace dance {
namespace {

using Eigen::Affine3f;
using Eigen::Vector3f;
using tinygltf::Value;

constexpr std::uint32_t kNone = ~std::uint32_t{0};

// As decimals of seven places: no more than a float holds of a metre.
double decimal(float value) { return std::round(static_cast<double>(value) * 1e7) / 1e7; }

class VrmFile {
 public:
  VrmFile(const AvatarModel& model, const VrmMeta& meta)
      : source_(model), meta_(meta), store_(out_) {
    out_.asset.version = "2.0";
    out_.asset.generator = "DanceGraph";
    out_.scenes.emplace_back();
    out_.defaultScene = 0;
  }

  Result<std::vector<std::uint8_t>> write() {
    add_nodes();
    add_skin();
    if (auto added = add_pictures(); !added) return tl::make_unexpected(added.error());
    for (const AvatarMaterial& material : source_.materials) add_material(material);
    add_meshes();
    const std::vector<int> ends = add_spring_ends();
    use("VRMC_vrm", vrm_extension(source_, meta_, meshes_));
    if (!source_.springs.empty()) use("VRMC_springBone", spring_extension(source_, ends));
    for (const std::string& name : used_) out_.extensionsUsed.push_back(name);
    return packed_glb(out_);
  }

 private:
  void use(const std::string& name, Value value) {
    out_.extensions[name] = std::move(value);
    used_.insert(name);
  }

  int add_node(const AvatarNode& from) {
    tinygltf::Node node;
    node.name = from.name;
    const Vector3f& t = from.translation_m;
    if (!t.isZero(0.0f)) node.translation = {decimal(t.x()), decimal(t.y()), decimal(t.z())};
    const auto& q = from.rotation.coeffs();
    if (from.rotation.angularDistance(Eigen::Quaternionf::Identity()) > 1e-6f)
      node.rotation = {decimal(q.x()), decimal(q.y()), decimal(q.z()), decimal(q.w())};
    const Vector3f& s = from.scale;
    if (s != Vector3f::Ones()) node.scale = {decimal(s.x()), decimal(s.y()), decimal(s.z())};
    const auto index = static_cast<int>(out_.nodes.size());
    out_.nodes.push_back(std::move(node));
    if (from.parent >= 0)
      out_.nodes[static_cast<std::size_t>(from.parent)].children.push_back(index);
    else
      out_.scenes.front().nodes.push_back(index);
    return index;
  }

  void add_nodes() {
    for (const AvatarNode& node : source_.nodes) {
      add_node(node);
      Affine3f local = Affine3f::Identity();
      local.translate(node.translation_m).rotate(node.rotation).scale(node.scale);
      rest_.push_back(node.parent < 0 ? local
                                      : rest_[static_cast<std::size_t>(node.parent)] * local);
    }
  }

  // A skin names each node once. Where the model has two joints of one node, the vertices of all
  // are brought into W, in which every node has one matrix.
  void add_skin() {
    tinygltf::Skin skin;
    std::map<int, std::uint16_t> joint_of_node;
    for (const AvatarJoint& joint : source_.joints) {
      const auto [at, is_new] =
          joint_of_node.try_emplace(joint.node, static_cast<std::uint16_t>(skin.joints.size()));
      if (is_new) skin.joints.push_back(joint.node);
      joint_.push_back(at->second);
    }
    in_world_ = skin.joints.size() < source_.joints.size();
    if (skin.joints.empty()) return;
    std::vector<float> inverse_binds;
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
      const Affine3f from_mesh = in_world_
                                     ? rest_[static_cast<std::size_t>(skin.joints[j])].inverse()
                                     : source_.joints[j].node_from_mesh;
      Eigen::Matrix4f matrix = from_mesh.matrix();
      matrix.row(3) << 0.0f, 0.0f, 0.0f, 1.0f;
      inverse_binds.insert(inverse_binds.end(), matrix.data(), matrix.data() + 16);
    }
    skin.inverseBindMatrices = store_.add_floats(inverse_binds, 16, GlbUse::kData);
    out_.skins.push_back(std::move(skin));
  }

  Result<void> add_pictures() {
    for (const AvatarPicture& picture : source_.pictures) {
      DANCE_TRY(const std::vector<std::uint8_t> png,
                png_of_rgba(picture.width_px, picture.height_px, picture.rgba));
      tinygltf::Image image;
      image.mimeType = "image/png";
      image.bufferView = store_.add_file(png);
      tinygltf::Texture texture;
      texture.source = static_cast<int>(out_.images.size());
      texture.sampler = 0;
      out_.images.push_back(std::move(image));
      out_.textures.push_back(std::move(texture));
    }
    if (source_.pictures.empty()) return {};
    tinygltf::Sampler sampler;
    sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
    sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
    out_.samplers.push_back(std::move(sampler));
    return {};
  }

  void add_material(const AvatarMaterial& from) {
    tinygltf::Material material;
    material.name = from.name;
    auto& surface = material.pbrMetallicRoughness;
    surface.baseColorFactor.clear();
    for (int c = 0; c < 4; ++c)
      surface.baseColorFactor.push_back(decimal(std::clamp(from.base_colour[c], 0.0f, 1.0f)));
    surface.metallicFactor = 0.0;
    surface.roughnessFactor = decimal(std::clamp(from.roughness, 0.0f, 1.0f));
    surface.baseColorTexture.index = from.picture;
    material.emissiveFactor.clear();  // newer releases of tinygltf begin with black
    for (int c = 0; c < 3; ++c)
      material.emissiveFactor.push_back(decimal(std::clamp(from.emission[c], 0.0f, 1.0f)));
    material.doubleSided = from.is_double_sided;
    if (from.alpha_mode == AlphaMode::kBlend) material.alphaMode = "BLEND";
    if (from.alpha_mode == AlphaMode::kMask) {
      material.alphaMode = "MASK";
      material.alphaCutoff = decimal(std::max(from.alpha_cutoff, 0.0f));
    }
    if (from.shading == Shading::kUnlit) {
      material.extensions["KHR_materials_unlit"] = Value(Value::Object());
      used_.insert("KHR_materials_unlit");
    } else if (from.shading == Shading::kToon) {
      material.extensions["VRMC_materials_mtoon"] = mtoon_extension(from);
      used_.insert("VRMC_materials_mtoon");
    }
    out_.materials.push_back(std::move(material));
  }

  // One mesh for the parts of each first-person kind, those that morphs move apart from the others:
  // the parts of a mesh have the same targets.
  void add_meshes() {
    std::vector<bool> is_moved(source_.vertices.size(), false);
    for (const AvatarMorph& morph : source_.morphs)
      for (const std::uint32_t vertex : morph.vertices) is_moved[vertex] = true;
    std::map<std::pair<FirstPerson, bool>, std::vector<const AvatarPart*>> groups;
    for (const AvatarPart& part : source_.parts) {
      if (part.index_count == 0) continue;
      const auto* begin = &source_.triangles[part.first_index];
      const bool moves = std::any_of(begin, begin + part.index_count,
                                     [&](std::uint32_t v) { return is_moved[v]; });
      groups[{part.first_person, moves}].push_back(&part);
    }
    for (const auto& [kind, parts] : groups) add_mesh(kind.first, parts);
  }

  void add_mesh(FirstPerson kind, const std::vector<const AvatarPart*>& parts) {
    VrmMesh placed;
    placed.first_person = kind;
    std::vector<bool> is_here(source_.vertices.size(), false);
    for (const AvatarPart* part : parts)
      for (std::uint32_t i = 0; i < part->index_count; ++i)
        is_here[source_.triangles[part->first_index + i]] = true;
    for (std::uint32_t m = 0; m < source_.morphs.size(); ++m)
      if (std::ranges::any_of(source_.morphs[m].vertices, [&](auto v) { return is_here[v]; }))
        placed.morphs.push_back(m);
    tinygltf::Mesh mesh;
    mesh.name = placed.morphs.empty() ? "body" : "face";
    for (const AvatarPart* part : parts)
      mesh.primitives.push_back(primitive_of(*part, placed.morphs));
    if (!placed.morphs.empty()) {
      Value::Array names;
      for (const std::uint32_t m : placed.morphs) names.emplace_back(source_.morphs[m].name);
      mesh.extras = Value(Value::Object{{"targetNames", Value(std::move(names))}});
      mesh.weights.assign(placed.morphs.size(), 0.0);
    }
    tinygltf::Node node;
    node.name = mesh.name;
    node.mesh = static_cast<int>(out_.meshes.size());
    if (!out_.skins.empty()) node.skin = 0;
    placed.node = static_cast<int>(out_.nodes.size());
    out_.meshes.push_back(std::move(mesh));
    out_.scenes.front().nodes.push_back(placed.node);
    out_.nodes.push_back(std::move(node));
    meshes_.push_back(std::move(placed));
  }

  // The linear part that brings a vertex into the axes that the skin has here, and its place there.
  Affine3f to_skin(const AvatarVertex& vertex) const {
    if (!in_world_) return Affine3f::Identity();
    Eigen::Matrix4f sum = Eigen::Matrix4f::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      const AvatarJoint& joint = source_.joints[vertex.joints[k]];
      sum += static_cast<float>(vertex.weights[k]) / 255.0f *
             (rest_[static_cast<std::size_t>(joint.node)] * joint.node_from_mesh).matrix();
    }
    return Affine3f(sum);
  }

  tinygltf::Primitive primitive_of(const AvatarPart& part,
                                   const std::vector<std::uint32_t>& morphs) {
    std::vector<std::uint32_t> local(source_.vertices.size(), kNone);
    std::vector<std::uint32_t> vertices;
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t i = 0; i < part.index_count; ++i) {
      const std::uint32_t vertex = source_.triangles[part.first_index + i];
      if (local[vertex] == kNone) {
        local[vertex] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(vertex);
      }
      triangles.push_back(local[vertex]);
    }
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = static_cast<int>(part.material);
    add_attributes(primitive, vertices, source_.materials[part.material].picture >= 0);
    primitive.indices = store_.add_indices(triangles);
    for (const std::uint32_t m : morphs)
      primitive.targets.push_back(target_of(source_.morphs[m], local, vertices.size()));
    return primitive;
  }

  void add_attributes(tinygltf::Primitive& primitive, const std::vector<std::uint32_t>& vertices,
                      bool has_picture) {
    std::vector<float> places;
    std::vector<float> normals;
    std::vector<float> uvs;
    std::vector<std::uint16_t> joints;
    std::vector<std::uint8_t> weights;
    for (const std::uint32_t v : vertices) {
      const AvatarVertex& vertex = source_.vertices[v];
      const Affine3f to = to_skin(vertex);
      const Vector3f place = to * vertex.place_m;
      const Vector3f turned = to.linear() * vertex.normal;
      const Vector3f normal =
          turned.norm() > 1e-6f ? Vector3f(turned.normalized()) : Vector3f(Vector3f::UnitY());
      places.insert(places.end(), place.data(), place.data() + 3);
      normals.insert(normals.end(), normal.data(), normal.data() + 3);
      uvs.insert(uvs.end(), vertex.uv.data(), vertex.uv.data() + 2);
      add_influences(vertex, joints, weights);
    }
    primitive.attributes["POSITION"] = store_.add_floats(places, 3, GlbUse::kVertices, true);
    primitive.attributes["NORMAL"] = store_.add_floats(normals, 3, GlbUse::kVertices);
    if (has_picture)
      primitive.attributes["TEXCOORD_0"] = store_.add_floats(uvs, 2, GlbUse::kVertices);
    if (out_.skins.empty()) return;
    if (out_.skins.front().joints.size() <= 256) {
      const std::vector<std::uint8_t> small(joints.begin(), joints.end());
      primitive.attributes["JOINTS_0"] = store_.add_bytes(small, false);
    } else {
      primitive.attributes["JOINTS_0"] = store_.add_shorts(joints);
    }
    primitive.attributes["WEIGHTS_0"] = store_.add_bytes(weights, true);
  }

  // A joint stands once among those of a vertex, and one without weight is joint 0.
  void add_influences(const AvatarVertex& vertex, std::vector<std::uint16_t>& joints,
                      std::vector<std::uint8_t>& weights) const {
    std::array<std::uint16_t, 4> own{};
    std::array<int, 4> sums{};
    for (std::size_t k = 0; k < 4; ++k) {
      if (vertex.weights[k] == 0) continue;
      const std::uint16_t joint = joint_[vertex.joints[k]];
      std::size_t at = 0;
      while (sums[at] > 0 && own[at] != joint) ++at;
      own[at] = joint;
      sums[at] += vertex.weights[k];
    }
    for (std::size_t k = 0; k < 4; ++k) {
      joints.push_back(own[k]);
      weights.push_back(static_cast<std::uint8_t>(sums[k]));
    }
  }

  std::map<std::string, int> target_of(const AvatarMorph& morph,
                                       const std::vector<std::uint32_t>& local, std::size_t count) {
    struct Move {
      Vector3f place;
      Vector3f normal;
    };
    std::map<std::uint32_t, Move> moves;  // by vertex of the part, ascending
    for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
      const std::uint32_t vertex = morph.vertices[i];
      if (local[vertex] == kNone) continue;
      const Eigen::Matrix3f turn = to_skin(source_.vertices[vertex]).linear();
      moves[local[vertex]] = {turn * morph.places_m[i], morph.normals.empty()
                                                            ? Vector3f(Vector3f::Zero())
                                                            : Vector3f(turn * morph.normals[i])};
    }
    // A target that moves nothing here still has to be there.
    if (moves.empty()) moves[0] = {Vector3f::Zero(), Vector3f::Zero()};
    std::vector<std::uint32_t> vertices;
    std::vector<Vector3f> places;
    std::vector<Vector3f> normals;
    for (const auto& [vertex, move] : moves) {
      vertices.push_back(vertex);
      places.push_back(move.place);
      normals.push_back(move.normal);
    }
    std::map<std::string, int> target;
    target["POSITION"] = store_.add_sparse(count, vertices, places);
    if (!morph.normals.empty()) target["NORMAL"] = store_.add_sparse(count, vertices, normals);
    return target;
  }

  // The last joint of a chain in VRM is an end that does not swing itself: a node of the model
  // where it has one there, else a new one.
  std::vector<int> add_spring_ends() {
    std::vector<int> ends;
    for (const AvatarSpring& spring : source_.springs) {
      ends.push_back(-1);
      if (spring.joints.empty()) continue;
      const AvatarSpring::Joint& last = spring.joints.back();
      for (std::size_t n = 0; n < source_.nodes.size(); ++n)
        if (source_.nodes[n].parent == last.node &&
            (source_.nodes[n].translation_m - last.tail_m).norm() < 1e-4f)
          ends.back() = static_cast<int>(n);
      if (ends.back() >= 0) continue;
      AvatarNode end;
      end.name = source_.nodes[static_cast<std::size_t>(last.node)].name + "End";
      end.parent = last.node;
      end.translation_m = last.tail_m;
      ends.back() = add_node(end);
    }
    return ends;
  }

  const AvatarModel& source_;
  const VrmMeta& meta_;
  tinygltf::Model out_;
  GlbStore store_;
  std::set<std::string> used_;
  std::vector<Affine3f> rest_;        // of each node, to W
  std::vector<std::uint16_t> joint_;  // of the skin, for each of the model's
  bool in_world_ = false;
  std::vector<VrmMesh> meshes_;
};

}  // namespace

Result<std::vector<std::uint8_t>> write_vrm(const AvatarModel& model, const VrmMeta& meta) {
  if (!is_sound(model)) return fail("a figure with indices or numbers that are wrong");
  if (model.node_of(Bone::kSpine) < 0) return fail("VRM wants a spine, and the figure has none");
  if (model.triangles.empty() || model.joints.empty()) return fail("the figure has no surface");
  if (meta.name.empty() && model.name.empty()) return fail("VRM wants a name of the figure");
  if (meta.authors.empty()) return fail("VRM wants an author of the figure");
  return VrmFile(model, meta).write();
}

}  // namespace dance

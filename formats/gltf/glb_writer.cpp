#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/base/assert.h"
#include "formats/body/body_mesh.h"
#include "formats/gltf/glb.h"
#include "formats/gltf/glb_container.h"
#include "formats/gltf/glb_skeleton.h"
#include "formats/gltf/glb_values.h"
#include "formats/gltf/glb_vrm.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

// A rotation that stays within this of a value in the whole clip is constant, about 0.1 mm at the
// end of an arm.
constexpr float kSameRotation = 5e-5f;
// JSON and container beside the numbers stay below this.
constexpr std::size_t kMostData_bytes = std::size_t{3} << 30;

static_assert(sizeof(Vector3f) == 3 * sizeof(float), "vectors are written as they lie");

// The dancer looks as in the viewer, which knows it by its id; a name that is none gets the look
// of the id nearest to it.
GuestId guest_named(const std::string& name) {
  std::string id;
  for (const char c : name.substr(0, kMaxGuestIdLength)) {
    const bool upper = c >= 'A' && c <= 'Z';
    const bool fits = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
    id += upper ? static_cast<char>(c + 32) : fits ? c : '-';
  }
  return GuestId::parse(id).value_or(GuestId());
}

class DanceWriter {
 public:
  explicit DanceWriter(tinygltf::Model& model) : model_(model), store_(model) {
    model_.animations.emplace_back();
    model_.animations.back().name = "dance";
    model_.scenes.emplace_back();
    model_.scenes.back().name = "stage";
    model_.defaultScene = 0;
    model_.asset.version = "2.0";
    model_.asset.generator = "DanceGraph";
  }

  void add(const NamedClip& named, const GlbOptions& options) {
    const MotionClip& clip = named.clip;
    const std::vector<GlbJoint> joints = glb_joints(clip.skeleton, !clip.hands.empty());
    const int first = add_nodes(named.name, joints);
    const int skin = add_skin(named.name, joints, first);
    if (options.has_bodies) add_body(named, skin);
    add_motion(clip, first);
    first_node_ = first;
  }

  // Of a single dancer, so that players of VRM animations find its bones too.
  void mark_vrm(bool has_hands) { mark_vrm_animation(model_, first_node_, has_hands); }

 private:
  // The dancer's node and below it the joints; gives the index of the hips.
  int add_nodes(const std::string& name, const std::vector<GlbJoint>& joints) {
    const auto dancer = static_cast<int>(model_.nodes.size());
    const int first = dancer + 1;
    tinygltf::Node root;
    root.name = name;
    root.children.push_back(first);
    model_.nodes.push_back(std::move(root));
    model_.scenes.front().nodes.push_back(dancer);
    for (const GlbJoint& joint : joints) {
      tinygltf::Node node;
      node.name = joint.name;
      const Eigen::Vector3d offset = joint.offset_m.cast<double>();
      node.translation = {offset.x(), offset.y(), offset.z()};
      model_.nodes.push_back(std::move(node));
    }
    for (std::size_t j = 0; j < joints.size(); ++j)
      if (joints[j].parent >= 0)
        model_.nodes[static_cast<std::size_t>(first + joints[j].parent)].children.push_back(
            first + static_cast<int>(j));
    return first;
  }

  int add_skin(const std::string& name, const std::vector<GlbJoint>& joints, int first) {
    tinygltf::Skin skin;
    skin.name = name;
    skin.skeleton = first;
    std::vector<float> inverse_binds;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      skin.joints.push_back(first + static_cast<int>(j));
      Eigen::Matrix4f inverse = Eigen::Matrix4f::Identity();
      inverse.topRightCorner<3, 1>() = -joints[j].place_m;
      inverse_binds.insert(inverse_binds.end(), inverse.data(), inverse.data() + 16);
    }
    skin.inverseBindMatrices = store_.add_floats(inverse_binds, 16, GlbUse::kData);
    model_.skins.push_back(std::move(skin));
    return static_cast<int>(model_.skins.size()) - 1;
  }

  // The node of a skinned mesh stands beside the dancer's: its place is that of the joints.
  void add_body(const NamedClip& named, int skin) {
    const GuestLook look = look_of(guest_named(named.name));
    tinygltf::Mesh mesh;
    mesh.name = named.name + " body";
    for (const BodyMeshPart& part : body_mesh(named.clip.skeleton, look, !named.clip.hands.empty()))
      mesh.primitives.push_back(primitive_of(part, look));
    tinygltf::Node node;
    node.name = mesh.name;
    node.mesh = static_cast<int>(model_.meshes.size());
    node.skin = skin;
    model_.meshes.push_back(std::move(mesh));
    model_.scenes.front().nodes.push_back(static_cast<int>(model_.nodes.size()));
    model_.nodes.push_back(std::move(node));
  }

  tinygltf::Primitive primitive_of(const BodyMeshPart& part, const GuestLook& look) {
    std::vector<std::uint8_t> joints;
    std::vector<std::uint8_t> weights;
    for (const SkinWeights& skin : part.skin) {
      joints.insert(joints.end(), skin.joints.begin(), skin.joints.end());
      weights.insert(weights.end(), skin.weights.begin(), skin.weights.end());
    }
    const auto floats_of = [](const std::vector<Vector3f>& vectors) {
      return std::span<const float>(vectors.front().data(), 3 * vectors.size());
    };
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.attributes["POSITION"] =
        store_.add_floats(floats_of(part.places_m), 3, GlbUse::kVertices, true);
    primitive.attributes["NORMAL"] =
        store_.add_floats(floats_of(part.normals), 3, GlbUse::kVertices);
    primitive.attributes["JOINTS_0"] = store_.add_bytes(joints, false);
    primitive.attributes["WEIGHTS_0"] = store_.add_bytes(weights, true);
    primitive.indices = store_.add_indices(part.triangles);
    primitive.material = add_material(look_of(part.material, look));
    return primitive;
  }

  int add_material(const MaterialLook& look) {
    tinygltf::Material material;
    material.name = std::string(look.name);
    auto& surface = material.pbrMetallicRoughness;
    surface.baseColorFactor = {static_cast<double>(look.colour.x()),
                               static_cast<double>(look.colour.y()),
                               static_cast<double>(look.colour.z()), 1.0};
    surface.metallicFactor = 0.0;
    surface.roughnessFactor = static_cast<double>(look.roughness);
    model_.materials.push_back(std::move(material));
    return static_cast<int>(model_.materials.size()) - 1;
  }

  void add_motion(const MotionClip& clip, int first) {
    times_ = -1;
    ends_ = -1;
    places_.clear();
    for (const Pose& pose : clip.frames)
      places_.insert(places_.end(), pose.p_WH_m.data(), pose.p_WH_m.data() + 3);
    add_channel(clip, first, "translation", store_.add_floats(places_, 3, GlbUse::kData), false);
    for (std::size_t b = 0; b < kBoneCount; ++b)
      add_rotation(clip, first + static_cast<int>(b),
                   [&](std::size_t f) { return clip.frames[f].R_PB[b]; });
    if (clip.hands.empty()) return;
    DANCE_ASSERT(clip.hands.size() == clip.frames.size(), clip.hands.size(), clip.frames.size());
    for (std::size_t bone = 0; bone < kFingerBoneCount; ++bone)
      add_rotation(clip, first + static_cast<int>(kBoneCount + bone),
                   [&](std::size_t f) { return clip.hands[f].R_PB[bone]; });
  }

  // A bone that stays as in T-pose needs no channel, one that stays as it is two keys.
  template <class RotationAt>
  void add_rotation(const MotionClip& clip, int node, RotationAt rotation_at) {
    std::vector<float>& values = rotations_;
    values.clear();
    bool is_constant = true;
    Quaternionf before = Quaternionf::Identity();
    for (std::size_t f = 0; f < clip.frames.size(); ++f) {
      Quaternionf q = rotation_at(f).normalized();
      // q and −q are one rotation, but between two keys a program takes the way of the numbers.
      if (q.dot(before) < 0.0f) q.coeffs() = -q.coeffs();
      before = q;
      values.insert(values.end(), q.coeffs().data(), q.coeffs().data() + 4);
      const Eigen::Map<const Eigen::Vector4f> first(values.data());
      is_constant = is_constant && (q.coeffs() - first).norm() < kSameRotation;
    }
    if (is_constant) {
      const Quaternionf q(values.data());
      if (q.angularDistance(Quaternionf::Identity()) < kSameRotation) return;
      values.resize(4);
      if (clip.frames.size() > 1)
        values.insert(values.end(), {values[0], values[1], values[2], values[3]});
    }
    add_channel(clip, node, "rotation", store_.add_floats(values, 4, GlbUse::kData), is_constant);
  }

  void add_channel(const MotionClip& clip, int node, const char* path, int output,
                   bool is_constant) {
    tinygltf::Animation& animation = model_.animations.front();
    tinygltf::AnimationSampler sampler;
    sampler.input = is_constant ? end_times(clip) : frame_times(clip);
    sampler.output = output;
    sampler.interpolation = "LINEAR";
    tinygltf::AnimationChannel channel;
    channel.sampler = static_cast<int>(animation.samplers.size());
    channel.target_node = node;
    channel.target_path = path;
    animation.samplers.push_back(std::move(sampler));
    animation.channels.push_back(std::move(channel));
  }

  int frame_times(const MotionClip& clip) {
    if (times_ >= 0) return times_;
    std::vector<float> times_s;
    for (std::size_t f = 0; f < clip.frames.size(); ++f)
      times_s.push_back(static_cast<float>(static_cast<double>(f) / clip.frame_hz));
    return times_ = store_.add_floats(times_s, 1, GlbUse::kData, true);
  }
  int end_times(const MotionClip& clip) {
    if (ends_ >= 0) return ends_;
    std::vector<float> times_s{0.0f};
    if (clip.frames.size() > 1)
      times_s.push_back(
          static_cast<float>(static_cast<double>(clip.frames.size() - 1) / clip.frame_hz));
    return ends_ = store_.add_floats(times_s, 1, GlbUse::kData, true);
  }

  tinygltf::Model& model_;
  GlbStore store_;
  int first_node_ = 0;  // of the last dancer's joints
  int times_ = -1;      // accessors of the clip at hand
  int ends_ = -1;
  std::vector<float> places_;
  std::vector<float> rotations_;
};

// The numbers of a clip as they are written, before any is left out.
std::size_t most_bytes(const MotionClip& clip) {
  const std::size_t bones = kBoneCount + (clip.hands.empty() ? 0 : kFingerBoneCount);
  return clip.frames.size() * sizeof(float) * (4 * bones + 4);
}

}  // namespace

Result<std::vector<std::uint8_t>> write_glb(const std::vector<NamedClip>& clips,
                                            const GlbOptions& options) {
  if (clips.empty()) return fail("nothing to write: there is no dancer");
  std::size_t bytes = 0;
  for (const NamedClip& named : clips) {
    if (named.clip.frames.empty()) return fail(named.name + " has no frames to write");
    bytes += most_bytes(named.clip);
  }
  if (bytes > kMostData_bytes)
    return fail("too long for one GLB, which holds 4 GiB; write parts of it");
  tinygltf::Model model;
  DanceWriter writer(model);
  for (const NamedClip& named : clips) writer.add(named, options);
  if (clips.size() == 1) writer.mark_vrm(!clips.front().clip.hands.empty());
  return packed_glb(model);
}

}  // namespace dance

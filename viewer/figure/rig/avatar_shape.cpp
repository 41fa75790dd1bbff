#include "viewer/figure/rig/avatar_shape.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <string_view>

#include "viewer/figure/rig/mesh_measure.h"

namespace dance {
namespace {

using Eigen::Affine3f;
using Eigen::Vector3f;

constexpr float kSmallest_m = 1e-4f;

std::vector<Affine3f> rest_places(const AvatarModel& model) {
  std::vector<Affine3f> M_from_node(model.nodes.size());
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    const AvatarNode& node = model.nodes[n];
    const Affine3f local =
        Eigen::Translation3f(node.translation_m) * node.rotation * Eigen::Scaling(node.scale);
    M_from_node[n] =
        node.parent < 0 ? local : M_from_node[static_cast<std::size_t>(node.parent)] * local;
  }
  return M_from_node;
}

bool has_word(std::string_view name, std::string_view word) {
  return std::search(name.begin(), name.end(), word.begin(), word.end(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) == b;
         }) != name.end();
}

// Works out a shape in steps; keeps what only they need.
class ShapeMaker {
 public:
  explicit ShapeMaker(const AvatarModel& model)
      : model_(model), M_from_node_(rest_places(model)), driver_of_(model.nodes.size(), -1) {}

  AvatarShape make() {
    shape_.drivers_M_m.assign(kFirstFreeDriver, Vector3f::Zero());
    name_bones();
    add_twists();
    add_eyes();
    add_swings();
    add_followers();
    add_colliders();
    measure();
    return std::move(shape_);
  }

 private:
  Vector3f place(std::size_t node) const { return M_from_node_[node].translation(); }

  void name_bones() {
    const auto claim = [&](int node, std::size_t driver) {
      if (node < 0 || driver_of_[static_cast<std::size_t>(node)] >= 0) return false;
      driver_of_[static_cast<std::size_t>(node)] = static_cast<int>(driver);
      shape_.drivers_M_m[driver] = place(static_cast<std::size_t>(node));
      return true;
    };
    for (const Bone needed : kNeededBones)
      shape_.has_bone[index_of(needed)] = claim(model_.node_of(needed), index_of(needed));
    for (std::size_t b = 0; b < kBoneCount; ++b)
      if (!shape_.has_bone[b]) shape_.has_bone[b] = claim(model_.bones[b], b);
    for (std::size_t f = 0; f < kFingerBoneCount; ++f)
      shape_.has_finger[f] = claim(model_.fingers[f], kFirstFingerDriver + f);
    // A needed bone on the node of another one still has a place.
    for (const Bone needed : kNeededBones)
      if (!shape_.has(needed) && model_.node_of(needed) >= 0)
        shape_.drivers_M_m[index_of(needed)] =
            place(static_cast<std::size_t>(model_.node_of(needed)));
  }

  // The nearest driver from the node upwards; the hips for what hangs on none.
  std::size_t driver_from(int node) const {
    for (; node >= 0; node = model_.nodes[static_cast<std::size_t>(node)].parent)
      if (driver_of_[static_cast<std::size_t>(node)] >= 0)
        return static_cast<std::size_t>(driver_of_[static_cast<std::size_t>(node)]);
    return index_of(Bone::kHips);
  }

  std::size_t add_driver(std::size_t node) {
    const std::size_t driver = shape_.drivers_M_m.size();
    shape_.leaders.push_back(driver_from(static_cast<int>(node)));
    shape_.drivers_M_m.push_back(place(node));
    driver_of_[node] = static_cast<int>(driver);
    return driver;
  }

  void add_twists() {
    constexpr std::array<std::pair<Bone, Bone>, 8> kTwisted{{
        {Bone::kLeftUpperArm, Bone::kLeftLowerArm},
        {Bone::kLeftLowerArm, Bone::kLeftHand},
        {Bone::kRightUpperArm, Bone::kRightLowerArm},
        {Bone::kRightLowerArm, Bone::kRightHand},
        {Bone::kLeftUpperLeg, Bone::kLeftLowerLeg},
        {Bone::kLeftLowerLeg, Bone::kLeftFoot},
        {Bone::kRightUpperLeg, Bone::kRightLowerLeg},
        {Bone::kRightLowerLeg, Bone::kRightFoot},
    }};
    constexpr std::size_t kMostNodes = 8;  // of one bone
    for (const auto& [bone, next] : kTwisted) {
      const int bone_node = model_.node_of(bone);
      std::vector<std::pair<float, std::size_t>> found;  // how far along the bone, node
      const Vector3f along = shape_.at(next) - shape_.at(bone);
      for (std::size_t n = 0; n < model_.nodes.size(); ++n) {
        const std::string& name = model_.nodes[n].name;
        if (driver_of_[n] >= 0 || model_.nodes[n].parent != bone_node) continue;
        if (!has_word(name, "twist") && !has_word(name, "roll")) continue;
        found.emplace_back(along.dot(place(n) - shape_.at(bone)), n);
      }
      std::ranges::sort(found);
      if (found.size() > kMostNodes) found.resize(kMostNodes);
      for (std::size_t i = 0; i < found.size(); ++i)
        shape_.twists.push_back({add_driver(found[i].second), bone,
                                 static_cast<std::uint8_t>(i + 1),
                                 static_cast<std::uint8_t>(found.size() + 1)});
    }
  }

  // Eyes that look by morphs are not turned as well.
  void add_eyes() {
    shape_.face = FaceMap(model_);
    for (std::size_t eye = 0; eye < 2; ++eye) {
      const int node = model_.eyes[eye];
      const bool is_free = node >= 0 && driver_of_[static_cast<std::size_t>(node)] < 0;
      if (is_free && !shape_.face.has_look())
        shape_.eyes[eye] = static_cast<int>(add_driver(static_cast<std::size_t>(node)));
    }
  }

  void add_swings() {
    struct Found {
      std::size_t node;
      std::size_t spring;
      std::size_t joint;
    };
    std::vector<Found> found;
    std::vector<bool> is_taken(model_.nodes.size());
    for (std::size_t s = 0; s < model_.springs.size(); ++s)
      for (std::size_t j = 0; j < model_.springs[s].joints.size(); ++j) {
        const auto node = static_cast<std::size_t>(model_.springs[s].joints[j].node);
        if (driver_of_[node] >= 0 || is_taken[node]) continue;  // a bone, or in two springs
        is_taken[node] = true;
        found.push_back({node, s, j});
      }
    std::ranges::sort(found, {}, &Found::node);  // parents have smaller indices
    std::size_t contacts_left = kMostSpringContacts;
    for (const Found& it : found) {
      if (shape_.swings.size() == kMostSwingingNodes) break;
      const std::size_t contacts =
          std::min(model_.springs[it.spring].colliders.size(), kMostSpringColliders);
      if (contacts > contacts_left) continue;
      const AvatarSpring::Joint& joint = model_.springs[it.spring].joints[it.joint];
      SwingNode swing;
      swing.tail_M_m = M_from_node_[it.node].linear() * joint.tail_m;
      if (swing.tail_M_m.norm() < kSmallest_m) continue;
      swing.parent = driver_from(model_.nodes[it.node].parent);
      swing.driver = add_driver(it.node);
      swing.radius_m = std::clamp(joint.radius_m * size_of(it.node), 0.0f, 1.0f);
      swing.stiffness = std::clamp(joint.stiffness, 0.0f, 100.0f);
      swing.drag = std::clamp(joint.drag, 0.0f, 1.0f);
      const float strength = std::clamp(joint.gravity, -100.0f, 100.0f);
      const float length = joint.gravity_direction.norm();
      if (length > 1e-6f) swing.gravity = joint.gravity_direction * (strength / length);
      contacts_left -= contacts;
      springs_.push_back(it.spring);
      shape_.swings.push_back(swing);
    }
  }

  float size_of(std::size_t node) const {
    return std::cbrt(std::abs(M_from_node_[node].linear().determinant()));
  }

  void add_followers() {
    for (const AvatarJoint& joint : model_.joints) {
      const Affine3f M_from_mesh =
          M_from_node_[static_cast<std::size_t>(joint.node)] * joint.node_from_mesh;
      AvatarShape::Follower follower;
      follower.driver = static_cast<std::uint32_t>(driver_from(joint.node));
      follower.linear = M_from_mesh.linear();
      follower.place_m = M_from_mesh.translation() - shape_.drivers_M_m[follower.driver];
      shape_.followers.push_back(follower);
    }
  }

  void add_colliders() {
    for (std::size_t i = 0; i < shape_.swings.size(); ++i) {
      const AvatarSpring& spring = model_.springs[springs_[i]];
      SwingNode& swing = shape_.swings[i];
      if (spring.centre >= 0) swing.centre = static_cast<int>(driver_from(spring.centre));
      if (i > 0 && springs_[i - 1] == springs_[i]) {
        swing.first_collider = shape_.swings[i - 1].first_collider;
        swing.collider_count = shape_.swings[i - 1].collider_count;
        continue;
      }
      swing.first_collider = static_cast<std::uint32_t>(shape_.colliders.size());
      for (const std::uint32_t c : spring.colliders) {
        if (swing.collider_count == kMostSpringColliders) break;
        const AvatarCollider& collider = model_.colliders[c];
        const auto node = static_cast<std::size_t>(collider.node);
        shape_.colliders.push_back({driver_from(collider.node),
                                    M_from_node_[node] * collider.centre_m,
                                    M_from_node_[node] * collider.tail_m,
                                    std::clamp(collider.radius_m * size_of(node), 0.0f, 1.0f)});
        ++swing.collider_count;
      }
    }
  }

  void measure() {
    const MeshMeasure mesh(model_, M_from_node_, shape_);
    shape_.height_m = mesh.height_m();
    shape_.crown_m = mesh.crown_m();
    for (std::size_t side = 0; side < 2; ++side) {
      shape_.soles[side] = mesh.sole(side);
      shape_.hulls[side] = mesh.hull(side);
      shape_.hand_ends_M_m[side] = mesh.hand_end(side);
    }
    shape_.eyes_M_m = eyes_M_m();
  }

  // A model without nodes for the eyes has them where a mannequin has them, in proportion to the
  // head.
  Vector3f eyes_M_m() const {
    const auto [left, right] = model_.eyes;
    if (left >= 0 && right >= 0)
      return 0.5f *
             (place(static_cast<std::size_t>(left)) + place(static_cast<std::size_t>(right)));
    return shape_.at(Bone::kHead) + shape_.crown_m * Vector3f(0.0f, 0.45f, 0.4f);
  }

  const AvatarModel& model_;
  const std::vector<Affine3f> M_from_node_;
  std::vector<int> driver_of_;
  std::vector<std::size_t> springs_;  // of each swing node
  AvatarShape shape_;
};

}  // namespace

AvatarShape shape_of(const AvatarModel& model) { return ShapeMaker(model).make(); }

}  // namespace dance

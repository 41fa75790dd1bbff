#include "formats/avatar/read/avatar_springs.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "formats/avatar/read/avatar_nodes.h"
#include "formats/gltf/glb_json.h"

namespace dance {
namespace {

using Eigen::Vector3f;
using tinygltf::Value;

constexpr float kLargest_m = 100.0f;
constexpr double kEnd_m = 0.07;  // how far VRM 0.x's last node of a chain reaches

Vector3f within(Vector3f v) { return v.cwiseMax(-kLargest_m).cwiseMin(kLargest_m); }

Vector3f listed_vector(const Value* list, const Vector3f& otherwise) {
  const auto numbers = numbers_of<3>(list);
  if (!numbers) return otherwise;
  return within(Eigen::Map<const Eigen::Vector3d>(numbers->data()).cast<float>());
}

// {x, y, z} of Unity, whose z is the other way round.
Vector3f named_vector(const Value* object, const Vector3f& otherwise) {
  const auto x = number_of(member(object, "x"));
  const auto y = number_of(member(object, "y"));
  const auto z = number_of(member(object, "z"));
  if (!x || !y || !z) return otherwise;
  return within(Eigen::Vector3d(*x, *y, -*z).cast<float>());
}

class SpringReader {
 public:
  explicit SpringReader(AvatarSource& source)
      : source_(source), rest_(rest_transforms(source.model)), is_taken_(rest_.size(), false) {
    const AvatarModel& model = source.model;
    const auto take = [&](const auto& nodes) {
      for (const int node : nodes)
        if (node >= 0) is_taken_[static_cast<std::size_t>(node)] = true;
    };
    take(model.bones);
    take(model.fingers);
    take(model.eyes);
    children_.resize(rest_.size());
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
      if (model.nodes[n].parent >= 0)
        children_[static_cast<std::size_t>(model.nodes[n].parent)].push_back(static_cast<int>(n));
  }

  void read_vrm1();
  void read_vrm0();

 private:
  std::optional<int> node_in(const Value* value) const {
    const auto node = index_in(value, source_.scene.nodes.size());
    return node ? std::optional(source_.model_node(*node)) : std::nullopt;
  }
  Vector3f gravity_of(Vector3f direction) const {
    const float length = direction.norm();
    if (!(length > 1e-6f)) return -Vector3f::UnitY();
    return source_.turned.cast<float>() * (direction / length);
  }
  // A place of the world at rest in the axes of a node.
  Vector3f seen_from(int node, const Eigen::Vector3d& place) const {
    const auto& T_MN = rest_[static_cast<std::size_t>(node)];
    if (!(std::abs(T_MN.linear().determinant()) > 1e-12)) return Vector3f::Zero();
    return within((T_MN.inverse() * place).cast<float>());
  }
  Eigen::Vector3d place_of(int node) const {
    return rest_[static_cast<std::size_t>(node)].translation();
  }

  std::optional<std::uint32_t> add_collider(const AvatarCollider& collider) {
    if (source_.model.colliders.size() >= source_.limits.colliders) {
      source_.note("more than " + std::to_string(source_.limits.colliders) +
                   " colliders; the rest is left out");
      return std::nullopt;
    }
    source_.model.colliders.push_back(collider);
    return static_cast<std::uint32_t>(source_.model.colliders.size() - 1);
  }

  // A spring's colliders: those of its groups, each once.
  std::vector<std::uint32_t> colliders_of(const Value* groups) const {
    std::vector<bool> is_in(source_.model.colliders.size(), false);
    for (std::size_t g = 0; g < std::min(length_of(groups), groups_.size()); ++g)
      if (const auto group = index_in(item(groups, g), groups_.size()))
        for (const std::uint32_t collider : groups_[static_cast<std::size_t>(*group)])
          is_in[collider] = true;
    std::vector<std::uint32_t> all;
    for (std::size_t c = 0; c < is_in.size(); ++c)
      if (is_in[c]) all.push_back(static_cast<std::uint32_t>(c));
    return all;
  }

  void add_spring(AvatarSpring spring) {
    if (spring.joints.empty()) return;
    if (source_.model.springs.size() >= source_.limits.springs ||
        spring.joints.size() > source_.limits.spring_joints - joint_count_)
      return source_.note("more than " + std::to_string(source_.limits.springs) +
                          " springs; the rest is left out");
    joint_count_ += spring.joints.size();
    source_.model.springs.push_back(std::move(spring));
  }

  // Nodes that are bones, or swing already, are not taken.
  bool may_take(int node) {
    if (!is_taken_[static_cast<std::size_t>(node)]) return true;
    source_.note("a spring at a bone of the body, or at another spring, is left out");
    return false;
  }
  void take(int node) { is_taken_[static_cast<std::size_t>(node)] = true; }

  void read_colliders_of_vrm1(const Value* springs);
  void read_colliders_of_vrm0(const Value* animation);
  void add_tree(int root, const AvatarSpring::Joint& like, const AvatarSpring& spring);

  AvatarSource& source_;
  const std::vector<Eigen::Affine3d> rest_;
  std::vector<bool> is_taken_;
  std::vector<std::vector<int>> children_;
  std::vector<std::vector<std::uint32_t>> groups_;
  std::size_t joint_count_ = 0;
};

void SpringReader::read_colliders_of_vrm1(const Value* springs) {
  const Value* colliders = member(springs, "colliders");
  std::vector<std::optional<std::uint32_t>> of_file;
  const std::size_t count = std::min(length_of(colliders), source_.limits.colliders);
  for (std::size_t c = 0; c < count; ++c) {
    of_file.emplace_back();
    const Value* from = item(colliders, c);
    const auto node = node_in(member(from, "node"));
    const Value* capsule = member(member(from, "shape"), "capsule");
    const Value* shape = capsule ? capsule : member(member(from, "shape"), "sphere");
    if (!node || !shape) continue;
    AvatarCollider collider;
    collider.node = *node;
    collider.centre_m = listed_vector(member(shape, "offset"), Vector3f::Zero());
    collider.tail_m =
        capsule ? listed_vector(member(shape, "tail"), collider.centre_m) : collider.centre_m;
    collider.radius_m = float_of(member(shape, "radius"), 0.0f, 0.0f, kLargest_m);
    of_file.back() = add_collider(collider);
  }
  const Value* groups = member(springs, "colliderGroups");
  for (std::size_t g = 0; g < std::min(length_of(groups), source_.limits.colliders); ++g) {
    groups_.emplace_back();
    const Value* listed = member(item(groups, g), "colliders");
    for (std::size_t c = 0; c < std::min(length_of(listed), of_file.size()); ++c)
      if (const auto index = index_in(item(listed, c), of_file.size()))
        if (of_file[static_cast<std::size_t>(*index)])
          groups_.back().push_back(*of_file[static_cast<std::size_t>(*index)]);
  }
}

void SpringReader::read_vrm1() {
  const Value* all = extension_of(source_.file.extensions, "VRMC_springBone");
  if (!all) return;
  read_colliders_of_vrm1(all);
  const Value* springs = member(all, "springs");
  for (std::size_t s = 0; s < std::min(length_of(springs), source_.limits.springs); ++s) {
    const Value* from = item(springs, s);
    AvatarSpring spring;
    spring.colliders = colliders_of(member(from, "colliderGroups"));
    spring.centre = node_in(member(from, "center")).value_or(-1);
    const Value* joints = member(from, "joints");
    for (std::size_t j = 0; j + 1 < length_of(joints); ++j) {
      const Value* settings = item(joints, j);
      const auto node = node_in(member(settings, "node"));
      const auto next = node_in(member(item(joints, j + 1), "node"));
      if (!node || !next || *node == *next || !is_above(source_.model, *node, *next) ||
          !may_take(*node))
        break;
      take(*node);
      AvatarSpring::Joint joint;
      joint.node = *node;
      joint.tail_m = seen_from(*node, place_of(*next));
      joint.radius_m = float_of(member(settings, "hitRadius"), 0.0f, 0.0f, kLargest_m);
      joint.stiffness = float_of(member(settings, "stiffness"), 1.0f, 0.0f, 1e3f);
      joint.gravity = float_of(member(settings, "gravityPower"), 0.0f, -1e3f, 1e3f);
      joint.gravity_direction =
          gravity_of(listed_vector(member(settings, "gravityDir"), -Vector3f::UnitY()));
      joint.drag = float_of(member(settings, "dragForce"), 0.5f, 0.0f, 1.0f);
      spring.joints.push_back(joint);
    }
    add_spring(std::move(spring));
  }
}

void SpringReader::read_colliders_of_vrm0(const Value* animation) {
  const Value* groups = member(animation, "colliderGroups");
  for (std::size_t g = 0; g < std::min(length_of(groups), source_.limits.colliders); ++g) {
    groups_.emplace_back();
    const auto node = node_in(member(item(groups, g), "node"));
    const Value* balls = member(item(groups, g), "colliders");
    for (std::size_t b = 0; node && b < length_of(balls); ++b) {
      AvatarCollider collider;
      collider.node = *node;
      collider.centre_m = named_vector(member(item(balls, b), "offset"), Vector3f::Zero());
      collider.tail_m = collider.centre_m;
      collider.radius_m = float_of(member(item(balls, b), "radius"), 0.0f, 0.0f, kLargest_m);
      const auto added = add_collider(collider);
      if (!added) return;
      groups_.back().push_back(*added);
    }
  }
}

// A chain goes on with the first child of each node; its other children begin chains of their own.
void SpringReader::add_tree(int root, const AvatarSpring::Joint& like, const AvatarSpring& spring) {
  std::vector<int> open{root};
  while (!open.empty()) {
    int node = open.back();
    open.pop_back();
    if (!may_take(node)) continue;
    AvatarSpring chain = spring;
    while (node >= 0 && may_take(node)) {
      take(node);
      const auto& below = children_[static_cast<std::size_t>(node)];
      AvatarSpring::Joint joint = like;
      joint.node = node;
      Eigen::Vector3d end = place_of(node);
      if (!below.empty()) {
        end = place_of(below.front());
        open.insert(open.end(), below.rbegin(), below.rend() - 1);
      } else {
        const int parent = source_.model.nodes[static_cast<std::size_t>(node)].parent;
        const Eigen::Vector3d along =
            parent >= 0 ? (end - place_of(parent)).eval() : -Eigen::Vector3d::UnitY();
        end += kEnd_m * (along.norm() > 1e-6 ? along.normalized() : -Eigen::Vector3d::UnitY());
      }
      joint.tail_m = seen_from(node, end);
      chain.joints.push_back(joint);
      node = below.empty() ? -1 : below.front();
    }
    add_spring(std::move(chain));
  }
}

void SpringReader::read_vrm0() {
  const Value* animation =
      member(extension_of(source_.file.extensions, "VRM"), "secondaryAnimation");
  if (!animation) return;
  read_colliders_of_vrm0(animation);
  const Value* all = member(animation, "boneGroups");
  for (std::size_t g = 0; g < std::min(length_of(all), source_.limits.springs); ++g) {
    const Value* from = item(all, g);
    AvatarSpring spring;
    spring.colliders = colliders_of(member(from, "colliderGroups"));
    spring.centre = node_in(member(from, "center")).value_or(-1);
    AvatarSpring::Joint like;
    like.radius_m = float_of(member(from, "hitRadius"), 0.02f, 0.0f, kLargest_m);
    like.stiffness = float_of(member(from, "stiffiness"), 1.0f, 0.0f, 1e3f);  // as VRM spells it
    like.gravity = float_of(member(from, "gravityPower"), 0.0f, -1e3f, 1e3f);
    like.gravity_direction =
        gravity_of(named_vector(member(from, "gravityDir"), -Vector3f::UnitY()));
    like.drag = float_of(member(from, "dragForce"), 0.4f, 0.0f, 1.0f);
    const Value* roots = member(from, "bones");
    for (std::size_t r = 0; r < std::min(length_of(roots), source_.limits.nodes); ++r)
      if (const auto root = node_in(item(roots, r))) add_tree(*root, like, spring);
  }
}

}  // namespace

void read_springs(AvatarSource& source) {
  SpringReader reader(source);
  reader.read_vrm1();
  if (source.model.springs.empty()) reader.read_vrm0();
  std::size_t nodes = 0;
  std::size_t contacts = 0;
  for (const AvatarSpring& spring : source.model.springs) {
    nodes += spring.joints.size();
    contacts += spring.joints.size() * std::min(spring.colliders.size(), kMostSpringColliders);
    if (spring.colliders.size() > kMostSpringColliders)
      source.note("a spring has more than " + std::to_string(kMostSpringColliders) +
                  " colliders; it passes through the rest");
  }
  if (nodes > kMostSwingingNodes)
    source.note(std::to_string(nodes) + " nodes swing, more than " +
                std::to_string(kMostSwingingNodes) + "; the rest stays at rest");
  if (contacts > kMostSpringContacts)
    source.note("its springs have more than " + std::to_string(kMostSpringContacts) +
                " pairs of a node and a collider; the nodes beyond stay at rest");
}

}  // namespace dance

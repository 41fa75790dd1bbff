#include "formats/gltf/glb_scene.h"

#include <cmath>

#include "formats/gltf/glb_text.h"

namespace dance {
namespace {

constexpr double kFurthest = 1e6;  // metres; further away is no stage but damage

std::string numbered(std::size_t node) { return "node " + std::to_string(node); }

bool are_sane(const std::vector<double>& values) {
  for (const double value : values)
    if (!std::isfinite(value) || std::abs(value) > kFurthest) return false;
  return true;
}

// A matrix is taken apart into translation, rotation and scale, which is all that it may hold.
bool take_apart(const std::vector<double>& m, GlbTransform& out) {
  const Eigen::Map<const Eigen::Matrix4d> matrix(m.data());
  Eigen::Matrix3d axes = matrix.topLeftCorner<3, 3>();
  for (int c = 0; c < 3; ++c) {
    out.scale[c] = axes.col(c).norm();
    if (!(out.scale[c] > 1e-12)) return false;
    axes.col(c) /= out.scale[c];
  }
  if (axes.determinant() < 0.0) {
    out.scale.x() = -out.scale.x();
    axes.col(0) = -axes.col(0);
  }
  out.translation = matrix.topRightCorner<3, 1>();
  out.rotation = Eigen::Quaterniond(axes).normalized();
  return out.rotation.coeffs().allFinite();
}

Result<GlbTransform> transform_of(const tinygltf::Node& node, std::size_t index) {
  const auto fits = [](const std::vector<double>& values, std::size_t count) {
    return values.empty() || (values.size() == count && are_sane(values));
  };
  if (!fits(node.matrix, 16) || !fits(node.translation, 3) || !fits(node.rotation, 4) ||
      !fits(node.scale, 3))
    return fail(numbered(index) + " has a transform with broken numbers");
  GlbTransform transform;
  if (!node.matrix.empty()) {
    if (!take_apart(node.matrix, transform))
      return fail(numbered(index) + " has a matrix that is no rotation and scale");
    return transform;
  }
  if (!node.translation.empty())
    transform.translation = Eigen::Map<const Eigen::Vector3d>(node.translation.data());
  if (!node.scale.empty()) transform.scale = Eigen::Map<const Eigen::Vector3d>(node.scale.data());
  if (!node.rotation.empty()) {
    transform.rotation.coeffs() = Eigen::Map<const Eigen::Vector4d>(node.rotation.data());
    if (!(transform.rotation.norm() > 0.5))
      return fail(numbered(index) + " has a rotation of length 0");
    transform.rotation.normalize();
  }
  return transform;
}

Result<void> adopt_children(const tinygltf::Node& node, std::size_t index, GlbScene& scene) {
  for (const int child : node.children) {
    if (child < 0 || static_cast<std::size_t>(child) >= scene.nodes.size())
      return fail(numbered(index) + " has a child that is not in the file");
    GlbNode& below = scene.nodes[static_cast<std::size_t>(child)];
    if (below.parent >= 0)
      return fail(numbered(static_cast<std::size_t>(child)) + " has two parents");
    below.parent = static_cast<int>(index);
    scene.nodes[index].children.push_back(child);
  }
  return {};
}

// From the roots down, breadth first: nodes of a cycle are reached from no root.
Result<void> order(const GlbLimits& limits, GlbScene& scene) {
  std::vector<std::size_t> depths(scene.nodes.size(), 0);
  for (std::size_t n = 0; n < scene.nodes.size(); ++n)
    if (scene.nodes[n].parent < 0) scene.parents_first.push_back(static_cast<int>(n));
  for (std::size_t next = 0; next < scene.parents_first.size(); ++next) {
    const auto node = static_cast<std::size_t>(scene.parents_first[next]);
    if (depths[node] > limits.depth) return fail("its nodes are nested too deeply");
    for (const int child : scene.nodes[node].children) {
      depths[static_cast<std::size_t>(child)] = depths[node] + 1;
      scene.parents_first.push_back(child);
    }
  }
  if (scene.parents_first.size() != scene.nodes.size())
    return fail("some of its nodes are below themselves");
  return {};
}

}  // namespace

Result<GlbScene> checked_scene(const tinygltf::Model& model, const GlbLimits& limits) {
  if (model.nodes.empty()) return fail("no nodes; the file holds no figure");
  if (model.nodes.size() > limits.nodes)
    return fail("more than " + std::to_string(limits.nodes) + " nodes");
  GlbScene scene;
  scene.nodes.resize(model.nodes.size());
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    scene.nodes[n].name = node_name(model.nodes[n].name);
    DANCE_TRY(scene.nodes[n].rest, transform_of(model.nodes[n], n));
    if (auto adopted = adopt_children(model.nodes[n], n, scene); !adopted)
      return tl::make_unexpected(adopted.error());
  }
  if (auto ordered = order(limits, scene); !ordered) return tl::make_unexpected(ordered.error());
  return scene;
}

}  // namespace dance

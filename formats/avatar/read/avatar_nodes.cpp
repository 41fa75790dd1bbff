#include "formats/avatar/read/avatar_nodes.h"

#include <cmath>
#include <numbers>

#include "core/pose/shortest_turn.h"
#include "formats/gltf/glb_text.h"

namespace dance {
namespace {

using Eigen::Affine3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kFurthest_m = 1e4;
constexpr double kLargestScale = 1e6;
// A figure that faces within this of an axis faces that axis: its bones are not quite symmetric.
constexpr double kSnap_rad = 10.0 * std::numbers::pi / 180.0;

std::string named(const AvatarNode& node, std::size_t index) {
  return node.name.empty() ? "node " + std::to_string(index) : "node '" + node.name + "'";
}

Result<void> check_places(const AvatarModel& model) {
  const std::vector<Affine3d> places = rest_transforms(model);
  for (std::size_t n = 0; n < places.size(); ++n)
    if (!places[n].matrix().allFinite() || places[n].translation().norm() > kFurthest_m ||
        places[n].linear().norm() > kLargestScale)
      return fail(named(model.nodes[n], n) + " is too far away or too large; export in metres");
  return {};
}

Vector3d place_of(const AvatarModel& model, const std::vector<Affine3d>& places, Bone bone) {
  return places[static_cast<std::size_t>(model.node_of(bone))].translation();
}

void turn(AvatarSource& source, const Quaterniond& by) {
  source.turned = (by * source.turned).normalized();
  for (AvatarNode& node : source.model.nodes) {
    if (node.parent >= 0) continue;
    node.translation_m = (by * node.translation_m.cast<double>()).cast<float>();
    node.rotation = (by * node.rotation.cast<double>()).normalized().cast<float>();
  }
}

// The turn that brings the head above the hips, by quarters; none for a figure that stands.
Quaterniond upright(const AvatarModel& model) {
  const std::vector<Affine3d> places = rest_transforms(model);
  const Vector3d up = place_of(model, places, Bone::kHead) - place_of(model, places, Bone::kHips);
  Eigen::Index axis = 0;
  up.cwiseAbs().maxCoeff(&axis);
  if (axis == 1 && up.y() > 0.0) return Quaterniond::Identity();
  Vector3d is_up = Vector3d::Zero();
  is_up[axis] = up[axis] < 0.0 ? -1.0 : 1.0;
  return shortest_turn(is_up, Vector3d::UnitY());
}

// The angle about +Y from where the figure faces to +Z.
double angle_to_front(const AvatarModel& model) {
  const std::vector<Affine3d> places = rest_transforms(model);
  Vector3d left = Vector3d::Zero();
  for (const auto& [l, r] : {std::pair(Bone::kLeftUpperLeg, Bone::kRightUpperLeg),
                             std::pair(Bone::kLeftUpperArm, Bone::kRightUpperArm)})
    left += place_of(model, places, l) - place_of(model, places, r);
  if (std::hypot(left.x(), left.z()) < 1e-6) return 0.0;
  // With the left at +X the front is at +Z; a turn by a about +Y brings (cos a, 0, sin a) to +X.
  const double angle = std::atan2(left.z(), left.x());
  constexpr double kQuarter = std::numbers::pi / 2.0;
  const double snapped = kQuarter * std::round(angle / kQuarter);
  return std::abs(angle - snapped) < kSnap_rad ? snapped : angle;
}

}  // namespace

Result<void> read_nodes(AvatarSource& source) {
  const GlbScene& scene = source.scene;
  source.node_of.assign(scene.nodes.size(), -1);
  for (const int from : scene.parents_first) {
    const GlbNode& node = scene.at(from);
    AvatarNode out;
    out.name = plain_name(node.name);
    out.parent = node.parent >= 0 ? source.model_node(node.parent) : -1;
    out.translation_m = node.rest.translation.cast<float>();
    out.rotation = node.rest.rotation.cast<float>().normalized();
    out.scale = node.rest.scale.cast<float>();
    source.node_of[static_cast<std::size_t>(from)] = static_cast<int>(source.model.nodes.size());
    source.model.nodes.push_back(std::move(out));
  }
  return check_places(source.model);
}

std::vector<Affine3d> rest_transforms(const AvatarModel& model) {
  std::vector<Affine3d> places;
  places.reserve(model.nodes.size());
  for (const AvatarNode& node : model.nodes) {
    Affine3d local = Eigen::Translation3d(node.translation_m.cast<double>()) *
                     node.rotation.cast<double>().normalized();
    local.scale(node.scale.cast<double>());
    places.push_back(node.parent >= 0 ? places[static_cast<std::size_t>(node.parent)] * local
                                      : local);
  }
  return places;
}

bool is_above(const AvatarModel& model, int ancestor, int node) {
  for (; node >= ancestor; node = model.nodes[static_cast<std::size_t>(node)].parent)
    if (node == ancestor) return true;
  return false;
}

Result<void> turn_to_front(AvatarSource& source) {
  const Quaterniond up = upright(source.model);
  if (up.angularDistance(Quaterniond::Identity()) > 1e-3) {
    turn(source, up);
    source.note("its head was not above its hips; the figure was set upright");
  }
  const double angle = angle_to_front(source.model);
  if (std::abs(angle) > 1e-6) {
    turn(source, Quaterniond(Eigen::AngleAxisd(angle, Vector3d::UnitY())));
    if (std::abs(std::abs(angle) - std::numbers::pi) > 1e-3)
      source.note("it faced sideways, and was turned by " +
                  std::to_string(std::lround(angle * 180.0 / std::numbers::pi)) + " degrees");
  }
  return check_places(source.model);
}

}  // namespace dance

#include "viewer/figure/rig/mesh_measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kLeastHeight_m = 0.1f;
constexpr float kMostHeight_m = 100.0f;
constexpr float kAverageCrown = 0.12f;  // of the height
constexpr int kMostlyTied = 128;        // of 255: weights of a vertex that is a foot's

}  // namespace

MeshMeasure::MeshMeasure(const AvatarModel& model, const std::vector<Eigen::Affine3f>& M_from_node,
                         const AvatarShape& shape)
    : model_(model), shape_(shape), places_M_m_(model.vertices.size()) {
  std::vector<Eigen::Affine3f> M_from_joint;
  for (const AvatarJoint& joint : model.joints)
    M_from_joint.push_back(M_from_node[static_cast<std::size_t>(joint.node)] *
                           joint.node_from_mesh);
  float low = kInfinity, high = -kInfinity;
  for (std::size_t v = 0; v < model.vertices.size(); ++v) {
    const AvatarVertex& vertex = model.vertices[v];
    Vector3f place = Vector3f::Zero();
    for (std::size_t k = 0; k < 4; ++k)
      if (vertex.weights[k] > 0)
        place += static_cast<float>(vertex.weights[k]) / 255.0f *
                 (M_from_joint[vertex.joints[k]] * vertex.place_m);
    places_M_m_[v] = place;
    low = std::min(low, place.y());
    high = std::max(high, place.y());
  }
  if (!(high > low)) {
    low = std::min(shape.at(Bone::kLeftFoot).y(), shape.at(Bone::kRightFoot).y());
    high = low + 1.15f * (shape.at(Bone::kHead).y() - low);
  }
  height_m_ = std::clamp(high - low, kLeastHeight_m, kMostHeight_m);
}

// Whether most of the vertex follows drivers first … last.
bool MeshMeasure::belongs(const AvatarVertex& vertex, std::size_t first, std::size_t last) const {
  int tied = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t driver = shape_.followers[vertex.joints[k]].driver;
    if (driver >= first && driver <= last) tied += vertex.weights[k];
  }
  return tied >= kMostlyTied;
}

float MeshMeasure::crown_m() const {
  const std::size_t head = index_of(Bone::kHead);
  float high = -kInfinity;
  for (std::size_t v = 0; v < places_M_m_.size(); ++v)
    if (belongs(model_.vertices[v], head, head)) high = std::max(high, places_M_m_[v].y());
  const float crown_m = high - shape_.at(Bone::kHead).y();
  return crown_m > 0.0f ? std::min(crown_m, height_m_) : kAverageCrown * height_m_;
}

SoleShape MeshMeasure::sole(std::size_t side) const {
  const std::size_t foot = index_of(side == 0 ? Bone::kLeftFoot : Bone::kRightFoot);
  static_assert(index_of(Bone::kLeftToes) == index_of(Bone::kLeftFoot) + 1);
  SoleShape sole;
  float low = kInfinity;
  for (std::size_t v = 0; v < places_M_m_.size(); ++v)
    if (belongs(model_.vertices[v], foot, foot + 1)) low = std::min(low, places_M_m_[v].y());
  const Vector3f& ankle = shape_.drivers_M_m[foot];
  if (low == kInfinity) {  // no mesh: an average foot
    sole.floor_m = ankle.y() - 0.045f * height_m_;
    if (shape_.has_bone[foot + 1])
      sole.floor_m = std::min(sole.floor_m, shape_.drivers_M_m[foot + 1].y());
    sole.heel_m = ankle.z() - 0.03f * height_m_;
    sole.tip_m = ankle.z() + 0.11f * height_m_;
    sole.inner_m = ankle.x() - 0.02f * height_m_;
    sole.outer_m = ankle.x() + 0.02f * height_m_;
    return sole;
  }
  // The footprint: what is nearly as low. Shoes curve up at their ends.
  sole = {low, kInfinity, -kInfinity, kInfinity, -kInfinity};
  for (std::size_t v = 0; v < places_M_m_.size(); ++v) {
    const Vector3f& place = places_M_m_[v];
    if (place.y() > low + 0.008f * height_m_ || !belongs(model_.vertices[v], foot, foot + 1))
      continue;
    sole.heel_m = std::min(sole.heel_m, place.z());
    sole.tip_m = std::max(sole.tip_m, place.z());
    sole.inner_m = std::min(sole.inner_m, place.x());
    sole.outer_m = std::max(sole.outer_m, place.x());
  }
  return sole;
}

SoleHull MeshMeasure::hull(std::size_t side) const {
  const std::size_t foot = index_of(side == 0 ? Bone::kLeftFoot : Bone::kRightFoot);
  std::vector<const Vector3f*> of_foot, of_toes;
  for (std::size_t v = 0; v < places_M_m_.size(); ++v) {
    if (!belongs(model_.vertices[v], foot, foot + 1)) continue;
    const bool is_toes =
        shape_.has_bone[foot + 1] && belongs(model_.vertices[v], foot + 1, foot + 1);
    (is_toes ? of_toes : of_foot).push_back(&places_M_m_[v]);
  }
  const auto add_lowest = [](const std::vector<const Vector3f*>& from, const Vector3f& down,
                             auto& points, std::size_t& count) {
    if (from.empty() || count == SoleHull::kMost) return;
    const Vector3f lowest = **std::ranges::max_element(
        from, {}, [&](const Vector3f* place) { return down.dot(*place); });
    const auto end = points.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::find(points.begin(), end, lowest) == end) points[count++] = lowest;
  };
  SoleHull hull;
  // Flat first: in the order in which they matter, should there be too many.
  for (const float roll : {0.0f, 0.4f, -0.4f, 0.8f, -0.8f})
    for (const float pitch : {0.0f, 0.3f, -0.3f, 0.6f, -0.6f, 0.9f, -0.9f, 1.2f, -1.2f, 1.5f}) {
      const Vector3f down(std::sin(roll), -std::cos(roll) * std::cos(pitch),
                          std::cos(roll) * std::sin(pitch));
      add_lowest(of_foot, down, hull.foot_m, hull.foot_count);
      add_lowest(of_toes, down, hull.toes_m, hull.toes_count);
    }
  return hull;
}

Vector3f MeshMeasure::hand_end(std::size_t side) const {
  const bool left = side == 0;
  const std::size_t hand = index_of(left ? Bone::kLeftHand : Bone::kRightHand);
  const std::size_t middle = (left ? 0 : kFingerBoneCount / 2) + 6;
  if (shape_.has_finger[middle]) return shape_.drivers_M_m[kFirstFingerDriver + middle];
  const std::size_t lower = index_of(left ? Bone::kLeftLowerArm : Bone::kRightLowerArm);
  const Vector3f& wrist = shape_.drivers_M_m[hand];
  Vector3f along = wrist - shape_.drivers_M_m[lower];
  along = along.norm() > 1e-5f ? Vector3f(along.normalized())
                               : Vector3f(left ? 1.0f : -1.0f, 0.0f, 0.0f);
  float length = 0.0f;
  const std::size_t first_finger = kFirstFingerDriver + (left ? 0 : kFingerBoneCount / 2);
  for (std::size_t v = 0; v < places_M_m_.size(); ++v)
    if (belongs(model_.vertices[v], hand, hand) ||
        belongs(model_.vertices[v], first_finger, first_finger + kFingerBoneCount / 2 - 1))
      length = std::max(length, along.dot(places_M_m_[v] - wrist));
  if (length < 0.03f * height_m_) length = 0.105f * height_m_;
  return wrist + 0.5f * std::min(length, 0.2f * height_m_) * along;
}

}  // namespace dance

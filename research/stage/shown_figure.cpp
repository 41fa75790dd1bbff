#include "research/stage/shown_figure.h"

#include <algorithm>
#include <cmath>

#include "viewer/figure/driver_pose.h"

namespace dance {
namespace {

using Eigen::Affine3f;
using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr std::array<Bone, 2> kUpper{Bone::kLeftUpperArm, Bone::kRightUpperArm};
constexpr std::array<Bone, 2> kLower{Bone::kLeftLowerArm, Bone::kRightLowerArm};
constexpr std::array<Bone, 2> kHand{Bone::kLeftHand, Bone::kRightHand};
constexpr std::array<Bone, 2> kFoot{Bone::kLeftFoot, Bone::kRightFoot};
constexpr float kPalm = 0.8f;  // of the way to where the middle finger begins

bool is_below(const AvatarModel& model, int node, int ancestor) {
  for (; node >= 0; node = model.nodes[static_cast<std::size_t>(node)].parent)
    if (node == ancestor) return true;
  return false;
}

}  // namespace

ShownFigure::ShownFigure(const AvatarModel& model)
    : model_(model), M_from_node_(model.nodes.size()), joint_of_(model.nodes.size(), -1) {
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    const AvatarNode& node = model.nodes[n];
    const Affine3f local =
        Eigen::Translation3f(node.translation_m) * node.rotation * Eigen::Scaling(node.scale);
    M_from_node_[n] =
        node.parent < 0 ? local : M_from_node_[static_cast<std::size_t>(node.parent)] * local;
  }
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    joint_of_[static_cast<std::size_t>(model.joints[j].node)] = static_cast<int>(j);
  for (std::size_t side = 0; side < 2; ++side) {
    const int lower = model.node_of(kLower[side]), hand = model.node_of(kHand[side]);
    const auto place = [&](int n) {
      return M_from_node_[static_cast<std::size_t>(n)].translation();
    };
    last_forearm_[side] = lower;
    float furthest = 0.0f;
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
      const int node = static_cast<int>(n);
      if (model.nodes[n].parent != lower || is_below(model, hand, node) || joint_of_[n] < 0)
        continue;
      if (model.nodes[n].name.find("wist") == std::string::npos) continue;
      const float along = (place(hand) - place(lower)).dot(place(node) - place(lower));
      if (along > furthest) furthest = along, last_forearm_[side] = node;
    }
    const int foot = model.node_of(kFoot[side]);
    for (std::uint32_t v = 0; v < model.vertices.size(); ++v) {
      int tied = 0;
      for (std::size_t k = 0; k < 4; ++k)
        if (is_below(model, model.joints[model.vertices[v].joints[k]].node, foot))
          tied += model.vertices[v].weights[k];
      if (tied >= 128) soles_[side].push_back(v);
    }
  }
}

Vector3f ShownFigure::palm_W_m(const PosedFigure& figure, std::size_t side) const {
  const int hand = model_.node_of(kHand[side]);
  const int middle = model_.fingers[side * kFingerBoneCount / 2 + 6];
  const auto place = [&](int node) -> std::optional<Vector3f> {
    if (node < 0 || joint_of_[static_cast<std::size_t>(node)] < 0) return std::nullopt;
    const auto j = static_cast<std::size_t>(joint_of_[static_cast<std::size_t>(node)]);
    const Vector3f in_mesh = model_.joints[j].node_from_mesh.inverse().translation();
    return Vector3f(figure.W_from_joint[j] * in_mesh.homogeneous());
  };
  const auto wrist = place(hand), knuckle = place(middle);
  if (wrist && knuckle) return *wrist + kPalm * (*knuckle - *wrist);
  const Tip tip = side == 0 ? Tip::kLeftHand : Tip::kRightHand;
  const Vector3f from = wrist.value_or(figure.frames.position(kHand[side]));
  return from + 0.5f * kPalm * (figure.frames.tip(tip) - figure.frames.position(kHand[side]));
}

std::optional<float> ShownFigure::sole_W_m(const PosedFigure& figure, std::size_t side) const {
  if (soles_[side].empty()) return std::nullopt;
  float low = 1e9f;
  for (const std::uint32_t v : soles_[side]) {
    const AvatarVertex& vertex = model_.vertices[v];
    float height = 0.0f;
    for (std::size_t k = 0; k < 4; ++k)
      if (vertex.weights[k] > 0)
        height += static_cast<float>(vertex.weights[k]) / 255.0f *
                  figure.W_from_joint[vertex.joints[k]].row(1).dot(vertex.place_m.homogeneous());
    low = std::min(low, height);
  }
  return low;
}

std::optional<Quaternionf> ShownFigure::turn_of(const PosedFigure& figure, int node) const {
  if (node < 0 || joint_of_[static_cast<std::size_t>(node)] < 0) return std::nullopt;
  const auto j = static_cast<std::size_t>(joint_of_[static_cast<std::size_t>(node)]);
  const Affine3f M_from_mesh =
      M_from_node_[static_cast<std::size_t>(node)] * model_.joints[j].node_from_mesh;
  const Eigen::Matrix3f D = figure.W_from_joint[j].leftCols<3>() * M_from_mesh.linear().inverse();
  // Gram-Schmidt: scale and stretch go.
  Eigen::Matrix3f R;
  R.col(0) = D.col(0).normalized();
  R.col(1) = (D.col(1) - R.col(0) * R.col(0).dot(D.col(1))).normalized();
  R.col(2) = R.col(0).cross(R.col(1));
  return Quaternionf(R);
}

double ShownFigure::twist_between(const PosedFigure& figure, std::size_t side, int first,
                                  int second) const {
  const auto a = turn_of(figure, first), b = turn_of(figure, second);
  if (!a || !b) return 0.0;
  const auto place = [&](Bone bone) {
    return M_from_node_[static_cast<std::size_t>(model_.node_of(bone))].translation();
  };
  const Vector3f axis = (place(kHand[side]) - place(kLower[side])).normalized();
  return std::abs(static_cast<double>(twist_rad(a->conjugate() * *b, axis)));
}

double ShownFigure::wrist_twist_rad(const PosedFigure& figure, std::size_t side) const {
  return twist_between(figure, side, last_forearm_[side], model_.node_of(kHand[side]));
}

double ShownFigure::elbow_twist_rad(const PosedFigure& figure, std::size_t side) const {
  return twist_between(figure, side, model_.node_of(kUpper[side]), model_.node_of(kLower[side]));
}

}  // namespace dance

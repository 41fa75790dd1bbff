// Rigs for the tests of retargeting, made of the mannequin: with axes of any kind, an A-pose,
// scaled nodes, nodes between bones, bones without a name.
//
// Units/frames: as formats/avatar/avatar_model.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <cmath>
#include <initializer_list>
#include <memory>
#include <vector>

#include "core/base/random.h"
#include "core/motion/rotation_vector.h"
#include "formats/avatar/mannequin_model.h"
#include "viewer/figure/figure_poser.h"

namespace dance {

inline AvatarModel mannequin_of(const Skeleton& skeleton) {
  return mannequin_model(skeleton, look_of(*GuestId::parse("guest")), true);
}

inline std::vector<Eigen::Affine3f> rest_of(const AvatarModel& model) {
  std::vector<Eigen::Affine3f> places;
  for (const AvatarNode& node : model.nodes) {
    const Eigen::Affine3f local =
        Eigen::Translation3f(node.translation_m) * node.rotation * Eigen::Scaling(node.scale);
    places.push_back(node.parent < 0 ? local
                                     : places[static_cast<std::size_t>(node.parent)] * local);
  }
  return places;
}

// The same figure at the same rest, though each node has axes of its own and the file is in other
// units: `unit` metres, put right by the scale of a node above the hips.
inline AvatarModel with_other_axes(const AvatarModel& from, std::uint64_t seed, float unit) {
  Random random(seed);
  AvatarModel model = from;
  const std::vector<Eigen::Affine3f> was = rest_of(from);
  AvatarNode root;
  root.name = "Armature";
  root.rotation = exp_rotation(Eigen::Vector3f(1.5f, 0.2f, -0.4f));
  root.scale.setConstant(unit);
  std::vector<Eigen::Affine3f> now{Eigen::Affine3f(root.rotation * Eigen::Scaling(root.scale))};
  model.nodes = {root};
  for (std::size_t n = 0; n < from.nodes.size(); ++n) {
    const auto any = [&] { return static_cast<float>(random.uniform() * 4.0 - 2.0); };
    const Eigen::Quaternionf R_M = exp_rotation(Eigen::Vector3f(any(), any(), any()));
    AvatarNode node = from.nodes[n];
    node.parent = from.nodes[n].parent + 1;
    const Eigen::Affine3f& above = now[static_cast<std::size_t>(node.parent)];
    node.translation_m = above.inverse() * was[n].translation();
    node.rotation =
        (Eigen::Quaternionf(Eigen::Matrix3f(above.linear() / unit)).conjugate() * R_M).normalized();
    node.scale.setOnes();
    now.push_back(above * (Eigen::Translation3f(node.translation_m) * node.rotation));
    model.nodes.push_back(node);
  }
  for (AvatarJoint& joint : model.joints) {
    const auto n = static_cast<std::size_t>(joint.node);
    joint.node_from_mesh = now[n + 1].inverse() * was[n] * joint.node_from_mesh;
    ++joint.node;
  }
  for (auto* bones : {&model.bones})
    for (int& node : *bones) node += node >= 0;
  for (int& node : model.fingers) node += node >= 0;
  return model;
}

// Arms hang so many degrees below the T-pose, legs stand a little apart.
inline AvatarModel in_a_pose(AvatarModel model, float degrees) {
  const float angle = degrees * 0.0174533f;
  const auto bend = [&](Bone bone, float about_z) {
    AvatarNode& node = model.nodes[static_cast<std::size_t>(model.node_of(bone))];
    node.rotation = node.rotation * exp_rotation(Eigen::Vector3f(0.0f, 0.0f, about_z));
  };
  bend(Bone::kLeftUpperArm, -angle);
  bend(Bone::kRightUpperArm, angle);
  bend(Bone::kLeftUpperLeg, 0.2f * angle);
  bend(Bone::kRightUpperLeg, -0.2f * angle);
  bend(Bone::kLeftFoot, -0.2f * angle);
  bend(Bone::kRightFoot, 0.2f * angle);
  return model;
}

inline AvatarModel without(AvatarModel model, std::initializer_list<Bone> bones) {
  for (const Bone bone : bones) model.bones[index_of(bone)] = -1;
  return model;
}

inline std::shared_ptr<const AvatarModel> shared(AvatarModel model) {
  return std::make_shared<const AvatarModel>(std::move(model));
}

inline SceneGuest guest_in(std::shared_ptr<const AvatarModel> avatar, const char* name = "alice") {
  SceneGuest guest;
  guest.id = *GuestId::parse(name);
  guest.pose.p_WH_m = Eigen::Vector3f(0.0f, guest.skeleton.hips_height_m(), 0.0f);
  guest.avatar = std::move(avatar);
  return guest;
}

// Any pose that is valid: each bone turned by up to `most_rad`.
inline Pose random_pose(Random& random, float most_rad, float hips_m) {
  Pose pose;
  const auto any = [&] { return static_cast<float>(random.uniform() * 2.0 - 1.0) * most_rad; };
  for (auto& R : pose.R_PB) R = exp_rotation(Eigen::Vector3f(any(), any(), any()) * 0.577f);
  pose.p_WH_m = Eigen::Vector3f(any(), hips_m, any());
  return pose;
}

// Where the places of a vertex come to be.
inline Eigen::Vector3f place_of(const PosedFigure& figure, std::size_t v) {
  const AvatarVertex& vertex = figure.model->vertices[v];
  Eigen::Vector3f place = Eigen::Vector3f::Zero();
  for (std::size_t k = 0; k < 4; ++k)
    place += static_cast<float>(vertex.weights[k]) / 255.0f *
             (figure.W_from_joint[vertex.joints[k]] * vertex.place_m.homogeneous());
  return place;
}

inline float lowest_of(const PosedFigure& figure) {
  float low = 1e9f;
  for (std::size_t v = 0; v < figure.model->vertices.size(); ++v)
    low = std::min(low, place_of(figure, v).y());
  return low;
}

}  // namespace dance

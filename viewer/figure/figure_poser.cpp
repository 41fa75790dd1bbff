#include "viewer/figure/figure_poser.h"

namespace dance {

using Eigen::Affine3f;
using Eigen::Quaternionf;

// What one guest's avatar keeps from picture to picture.
struct FigurePoser::Rig {
  std::shared_ptr<const AvatarModel> model;
  std::vector<Quaternionf> rest_W;  // of each node
  std::vector<Affine3f> W_from_node;
};

FigurePoser::FigurePoser() = default;
FigurePoser::~FigurePoser() = default;

std::span<const PosedFigure> FigurePoser::pose(const SceneState& scene) {
  figures_.clear();
  for (const SceneGuest& guest : scene.guests) {
    if (guest.avatar == nullptr || guest.opacity <= 0.0f) continue;
    const AvatarModel& model = *guest.avatar;
    PosedFigure figure;
    figure.id = guest.id;
    figure.model = guest.avatar;
    figure.opacity = guest.opacity;
    figure.morph_weights.assign(model.morphs.size(), 0.0f);
    forward_kinematics(guest.skeleton, guest.pose, figure.frames);
    std::vector<int> bone_of(model.nodes.size(), -1);
    for (std::size_t b = 0; b < kBoneCount; ++b)
      if (model.bones[b] >= 0)
        bone_of[static_cast<std::size_t>(model.bones[b])] = static_cast<int>(b);
    std::vector<Affine3f> W_from_node(model.nodes.size());
    std::vector<Quaternionf> rest_W(model.nodes.size());
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
      const AvatarNode& node = model.nodes[n];
      const auto parent = static_cast<std::size_t>(std::max(node.parent, 0));
      const Quaternionf parent_W = node.parent < 0 ? Quaternionf::Identity() : rest_W[parent];
      rest_W[n] = parent_W * node.rotation;
      Affine3f local =
          Eigen::Translation3f(node.translation_m) * node.rotation * Eigen::Scaling(node.scale);
      if (bone_of[n] >= 0) {
        const auto bone = static_cast<std::size_t>(bone_of[n]);
        local = Eigen::Translation3f(node.translation_m) *
                (parent_W.conjugate() * guest.pose.R_PB[bone] * rest_W[n]) *
                Eigen::Scaling(node.scale);
      }
      W_from_node[n] = node.parent < 0 ? local : W_from_node[parent] * local;
      if (bone_of[n] == static_cast<int>(index_of(Bone::kHips)))
        W_from_node[n].translation() = guest.pose.p_WH_m;
    }
    for (const AvatarJoint& joint : model.joints)
      figure.W_from_joint.push_back(
          (W_from_node[static_cast<std::size_t>(joint.node)] * joint.node_from_mesh)
              .matrix()
              .topRows<3>());
    figures_.push_back(std::move(figure));
  }
  return figures_;
}

}  // namespace dance

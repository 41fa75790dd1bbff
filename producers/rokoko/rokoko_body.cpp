#include "producers/rokoko/rokoko_body.h"

namespace dance {
namespace {

constexpr std::size_t kFingers = 10;

Eigen::Quaternionf rotation_W(const RokokoActor& actor, std::size_t joint) {
  return rokoko_to_W(joint, actor.joints[joint].rotation).normalized();
}

}  // namespace

FigureFrame figure_of(const RokokoActor& actor) {
  FigureFrame figure;
  for (std::size_t j = 0; j < kRokokoBodyJointCount; ++j) {
    const auto bone = bone_of(static_cast<RokokoBody>(j));
    if (!bone || !actor.present[j]) continue;
    figure.put(*bone, mirrored(actor.joints[j].position), rotation_W(actor, j));
  }
  const auto tip = [&](Tip which, std::size_t joint) {
    if (actor.present[joint]) figure.put_tip(which, mirrored(actor.joints[joint].position));
  };
  tip(Tip::kLeftToes, index_of(RokokoBody::kLeftToeEnd));
  tip(Tip::kRightToes, index_of(RokokoBody::kRightToeEnd));
  return figure;
}

bool hands_of(const RokokoActor& actor, const FigureFrame& figure, Hands& hands) {
  hands.presence = 0;
  for (std::size_t f = 0; f < kFingers; ++f) {
    const bool is_left = f < kFingers / 2;
    if (!(is_left ? actor.has_left_glove : actor.has_right_glove)) continue;
    Eigen::Quaternionf R_WP = figure.R_WB[index_of(is_left ? Bone::kLeftHand : Bone::kRightHand)];
    for (std::size_t bone = 0; bone < 3; ++bone) {
      const std::size_t joint = rokoko_finger_joint(f, bone);
      if (!actor.present[joint]) break;
      const Eigen::Quaternionf R_W = rotation_W(actor, joint);
      hands.R_PB[3 * f + bone] = (R_WP.conjugate() * R_W).normalized();
      hands.presence |= 1u << (3 * f + bone);
      R_WP = R_W;
    }
  }
  return hands.presence != 0;
}

}  // namespace dance

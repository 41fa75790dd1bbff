#include <algorithm>

#include "core/pose/kinematics.h"
#include "formats/body/hand_layout.h"
#include "research/joined_palms.h"
#include "research/stage/stage_take.h"
#include "viewer/figure/limb_fit.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr std::array<Limb, 2> kArm{kLeftArm, kRightArm};

struct Palms {
  std::array<Vector3f, 2> at_W_m;
  std::array<Vector3f, 2> moved_m{Vector3f::Zero(), Vector3f::Zero()};
};

Vector3f palm_of(const Skeleton& skeleton, const BodyFrames& at, std::size_t side) {
  const std::size_t hand = index_of(kArm[side].end);
  const std::size_t middle = side * kFingerBoneCount / 2 + 6;
  return at.p_WB_m[hand] + at.R_WB[hand] * (0.8f * hand_layout(skeleton).offset_m[middle]);
}

void move_palms(const Palms& palms, BodyFrames& at, Pose& pose) {
  for (std::size_t side = 0; side < 2; ++side) {
    if (palms.moved_m[side].norm() < 1e-6f) continue;
    const Limb& arm = kArm[side];
    const std::size_t upper = index_of(arm.upper), lower = index_of(arm.lower),
                      hand = index_of(arm.end);
    fit_limb(arm, at.p_WB_m[hand] + palms.moved_m[side], at.R_WB[upper] * hinge_of(arm), 1.0f, at);
    const auto parent = static_cast<std::size_t>(kBones[upper].parent);
    pose.R_PB[upper] = (at.R_WB[parent].conjugate() * at.R_WB[upper]).normalized();
    pose.R_PB[lower] = (at.R_WB[upper].conjugate() * at.R_WB[lower]).normalized();
    pose.R_PB[hand] = (at.R_WB[lower].conjugate() * at.R_WB[hand]).normalized();
  }
}

}  // namespace

void join_hands(StageTake& take, float join_m) {
  if (join_m <= 0.0f) return;
  std::size_t frames = take.dancers.front().clip.frames.size();
  for (const StageDancer& dancer : take.dancers)
    frames = std::min(frames, dancer.clip.frames.size());
  for (std::size_t f = 0; f < frames; ++f) {
    std::vector<BodyFrames> at(take.dancers.size());
    std::vector<Palms> palms(take.dancers.size());
    for (std::size_t d = 0; d < take.dancers.size(); ++d) {
      const MotionClip& clip = take.dancers[d].clip;
      forward_kinematics(clip.skeleton, clip.frames[f], at[d]);
      for (std::size_t side = 0; side < 2; ++side)
        palms[d].at_W_m[side] = palm_of(clip.skeleton, at[d], side);
    }
    for (std::size_t a = 0; a < palms.size(); ++a)
      for (std::size_t b = a + 1; b < palms.size(); ++b) {
        const auto shifts = joined_palm_shifts({palms[a].at_W_m, palms[b].at_W_m}, join_m);
        for (std::size_t side = 0; side < 2; ++side) {
          palms[a].moved_m[side] += shifts[0][side];
          palms[b].moved_m[side] += shifts[1][side];
        }
      }
    for (std::size_t d = 0; d < take.dancers.size(); ++d)
      move_palms(palms[d], at[d], take.dancers[d].clip.frames[f]);
  }
}

}  // namespace dance

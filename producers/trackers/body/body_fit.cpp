#include "producers/trackers/body/body_fit.h"

#include <algorithm>

#include "producers/trackers/body/limb_reach.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

// A joint that is nearly straight bends where the guess's limb would bend.
constexpr float kElbowBends_m = 0.02f, kKneeBends_m = 0.03f;

}  // namespace

Place TrackerBodyFit::follow(const Step& step, TrackedPoint point, const Place& guessed) {
  const Place* measured = step.bones.has(point) ? &step.bones.of(point) : nullptr;
  // Head and hands are shown where they are measured.
  const bool is_worn = index_of(point) > index_of(TrackedPoint::kRightHand);
  const bool jumps = measured != nullptr ? is_worn && step.mounts_changed : step.points_changed;
  return fades_[index_of(point)].follow(measured, guessed, step.seconds, jumps);
}

void TrackerBodyFit::fit_trunk(Step& step) {
  BodyFrames& frames = step.frames;
  const Place hips =
      follow(step, TrackedPoint::kHips, {step.guess.p_WH_m, step.guess.R(Bone::kHips)});
  frames.p_WB_m[0] = hips.p_W_m;
  frames.R_WB[0] = hips.R_W;
  const Quaternionf& R_guess = step.guess.R(Bone::kUpperChest);
  const Place chest = follow(step, TrackedPoint::kChest, {Vector3f::Zero(), R_guess});
  frames.R_WB[index_of(Bone::kUpperChest)] = chest.R_W;
  const Place& head = step.bones.of(TrackedPoint::kHead);
  bend_spine(step.skeleton, head.p_W_m, frames);
  frames.R_WB[index_of(Bone::kHead)] = head.R_W;
  // Shoulders go with the chest, as they were guessed on it.
  const Quaternionf turn = frames.R_WB[index_of(Bone::kUpperChest)] * R_guess.conjugate();
  for (const Bone bone : {Bone::kLeftShoulder, Bone::kRightShoulder})
    frames.R_WB[index_of(bone)] = (turn * step.guess.R(bone)).normalized();
}

void TrackerBodyFit::fit_arm(Step& step, bool left) {
  const Limb& arm = left ? kLeftArm : kRightArm;
  const std::size_t shoulder = index_of(left ? Bone::kLeftShoulder : Bone::kRightShoulder);
  const std::size_t upper = index_of(arm.upper), lower = index_of(arm.lower),
                    end = index_of(arm.end);
  BodyFrames& frames = step.frames;
  const Skeleton& skeleton = step.skeleton;
  const auto chest = index_of(Bone::kUpperChest);
  frames.p_WB_m[shoulder] = frames.p_WB_m[chest] + frames.R_WB[chest] * skeleton.offset_m[shoulder];
  const auto place_upper = [&] {
    frames.p_WB_m[upper] =
        frames.p_WB_m[shoulder] + frames.R_WB[shoulder] * skeleton.offset_m[upper];
  };
  place_upper();
  const Vector3f elbow = frames.p_WB_m[upper] + frames.R_WB[upper] * skeleton.offset_m[lower];
  const Vector3f wrist = elbow + frames.R_WB[lower] * skeleton.offset_m[end];
  const Place hand = follow(step, left ? TrackedPoint::kLeftHand : TrackedPoint::kRightHand,
                            {wrist, step.guess.R(arm.end)});
  const Place above = follow(step, left ? TrackedPoint::kLeftElbow : TrackedPoint::kRightElbow,
                             {frames.p_WB_m[upper], frames.R_WB[upper]});
  raise_shoulder(skeleton, arm, hand.p_W_m, frames);
  frames.R_WB[upper] = above.R_W;
  const Vector3f joint = above.p_W_m + above.R_W * skeleton.offset_m[lower];
  const Vector3f bends = above.R_W * Vector3f(0.0f, 0.0f, -kElbowBends_m);
  reach_limb(skeleton, arm, hand.p_W_m, joint, bends, frames);
  frames.R_WB[end] = hand.R_W;
}

Place TrackerBodyFit::foot_goal(Step& step, std::size_t side, const Vector3f& hip) {
  const bool left = side == 0;
  const Limb& leg = left ? kLeftLeg : kRightLeg;
  const Skeleton& skeleton = step.skeleton;
  const TrackedPoint point = left ? TrackedPoint::kLeftFoot : TrackedPoint::kRightFoot;
  const Vector3f o_ball = skeleton.offset(left ? Bone::kLeftToes : Bone::kRightToes);
  const float rest_m = -skeleton.tip(left ? Tip::kLeftToes : Tip::kRightToes).y();
  const Place guessed{step.guess.ankles_W_m[side], step.guess.R(leg.end)};
  Place foot;
  if (step.bones.has(point)) {
    holds_[side].reset();
    foot = follow(step, point, guessed);
  } else {
    const Place held =
        holds_[side].follow(guessed, o_ball, rest_m, step.guess.stands[side], step.seconds);
    foot = follow(step, point, held);
    const float leg_m = skeleton.offset(leg.lower).norm() + skeleton.offset(leg.end).norm();
    raise_heel(hip, leg_m, o_ball, foot);
  }
  keep_above_floor(skeleton, left, foot);
  return foot;
}

void TrackerBodyFit::fit_leg(Step& step, std::size_t side) {
  const bool left = side == 0;
  const Limb& leg = left ? kLeftLeg : kRightLeg;
  const std::size_t upper = index_of(leg.upper), lower = index_of(leg.lower),
                    end = index_of(leg.end),
                    toes = index_of(left ? Bone::kLeftToes : Bone::kRightToes);
  BodyFrames& frames = step.frames;
  const Skeleton& skeleton = step.skeleton;
  frames.p_WB_m[upper] = frames.p_WB_m[0] + frames.R_WB[0] * skeleton.offset_m[upper];
  const Place foot = foot_goal(step, side, frames.p_WB_m[upper]);
  const Place above = follow(step, left ? TrackedPoint::kLeftKnee : TrackedPoint::kRightKnee,
                             {frames.p_WB_m[upper], frames.R_WB[upper]});
  frames.R_WB[upper] = above.R_W;
  const Vector3f knee = above.p_W_m + above.R_W * skeleton.offset_m[lower];
  const Vector3f bends = above.R_W * Vector3f(0.0f, 0.0f, kKneeBends_m);
  reach_limb(skeleton, leg, foot.p_W_m, knee, bends, frames);
  frames.R_WB[end] = foot.R_W;
  frames.R_WB[toes] = toes_on_floor(skeleton, left, {frames.p_WB_m[end], foot.R_W});
}

void TrackerBodyFit::fit(const Skeleton& skeleton, const BodyGuess& guess, const BonePlaces& bones,
                         bool mounts_changed, float seconds, Pose& pose) {
  Step step{skeleton, guess, bones, seconds, bones.presence != presence_, mounts_changed, {}};
  presence_ = bones.presence;
  step.frames.R_WB = guess.R_WB;
  step.frames.p_WB_m.fill(Vector3f::Zero());
  step.frames.p_WT_m.fill(Vector3f::Zero());
  fit_trunk(step);
  fit_arm(step, true);
  fit_arm(step, false);
  fit_leg(step, 0);
  fit_leg(step, 1);
  pose.p_WH_m = step.frames.p_WB_m[0];
  pose.R_PB[0] = step.frames.R_WB[0].normalized();
  for (std::size_t b = 1; b < kBoneCount; ++b) {
    const auto parent = static_cast<std::size_t>(kBones[b].parent);
    pose.R_PB[b] = (step.frames.R_WB[parent].conjugate() * step.frames.R_WB[b]).normalized();
  }
}

}  // namespace dance

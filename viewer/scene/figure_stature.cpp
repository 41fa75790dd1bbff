#include "viewer/scene/figure_stature.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

using Eigen::Vector3f;

// A file may hold a figure of any proportions.
constexpr float kLeastRatio = 0.1f;
constexpr float kMostRatio = 10.0f;
constexpr float kLeastPart_m = 1e-3f;
// From the joint at the base of the skull to the crown: eyes are nearly half way up, and in front.
constexpr float kEyesUp = 0.45f;
constexpr float kEyesForward = 0.5f;
// Eyes of a model that are further from its head than this, of its body, are none.
constexpr float kFurthestEyes = 0.6f;

// The lengths that tell of a figure at rest.
struct Measures {
  float leg_m = 0.0f;   // thigh and shank
  float body_m = 0.0f;  // from the hip joints up to the head
};

Vector3f rest_place_m(const AvatarModel& model, int node) {
  Vector3f place = Vector3f::Zero();
  for (int n = node; n >= 0; n = model.nodes[static_cast<std::size_t>(n)].parent) {
    const AvatarNode& it = model.nodes[static_cast<std::size_t>(n)];
    place = it.translation_m + it.rotation * it.scale.cwiseProduct(place);
  }
  return place;
}

Measures measures_of(const AvatarModel& model) {
  const auto at = [&](Bone bone) { return rest_place_m(model, model.node_of(bone)); };
  const Vector3f hip = at(Bone::kLeftUpperLeg), knee = at(Bone::kLeftLowerLeg);
  return {(knee - hip).norm() + (at(Bone::kLeftFoot) - knee).norm(), at(Bone::kHead).y() - hip.y()};
}

Measures measures_of(const Skeleton& dancer) {
  BodyFrames rest;
  forward_kinematics(dancer, Pose(), rest);
  return {dancer.offset(Bone::kLeftLowerLeg).norm() + dancer.offset(Bone::kLeftFoot).norm(),
          rest.position(Bone::kHead).y() - rest.position(Bone::kLeftUpperLeg).y()};
}

float ratio(float figure_m, float dancer_m) {
  const bool is_known = figure_m > kLeastPart_m && dancer_m > kLeastPart_m;
  return is_known ? std::clamp(figure_m / dancer_m, kLeastRatio, kMostRatio) : 1.0f;
}

bool is_leg(std::size_t bone) {
  return bone >= index_of(Bone::kLeftUpperLeg) && bone <= index_of(Bone::kRightToes);
}
bool is_foot(Tip tip) { return tip == Tip::kLeftToes || tip == Tip::kRightToes; }

void to_figure(const FigureStature& stature, BodyFrames& frames) {
  const Vector3f middle =
      0.5f * (frames.position(Bone::kLeftUpperLeg) + frames.position(Bone::kRightUpperLeg));
  const Vector3f to(middle.x(), middle.y() * stature.legs, middle.z());
  const auto place = [&](Vector3f& point, bool is_of_leg) {
    point = to + (is_of_leg ? stature.legs : stature.body) * (point - middle);
  };
  for (std::size_t b = 0; b < kBoneCount; ++b) place(frames.p_WB_m[b], is_leg(b));
  for (std::size_t t = 0; t < kTipCount; ++t) place(frames.p_WT_m[t], is_foot(static_cast<Tip>(t)));
}

}  // namespace

FigureStature stature_of(const SceneGuest& guest) {
  const float wanted = std::isfinite(guest.height_scale)
                           ? std::clamp(guest.height_scale, kLeastHeightScale, kMostHeightScale)
                           : 1.0f;
  if (!guest.avatar) return {wanted, wanted, wanted};
  const Measures figure = measures_of(*guest.avatar), dancer = measures_of(guest.skeleton);
  const float legs = ratio(figure.leg_m, dancer.leg_m);
  const float scale = guest.figure_size == FigureSize::kOwn ? wanted : wanted / legs;
  return {scale, scale * legs, scale * ratio(figure.body_m, dancer.body_m)};
}

float figure_height_m(const SceneGuest& guest) {
  const FigureStature stature = stature_of(guest);
  const float legs_m = guest.skeleton.hips_height_m();
  return stature.legs * legs_m + stature.body * (standing_height_m(guest.skeleton) - legs_m);
}

void figure_frames(const SceneGuest& guest, BodyFrames& frames) {
  forward_kinematics(guest.skeleton, guest.pose, frames);
  to_figure(stature_of(guest), frames);
}

Vector3f figure_eyes_W_m(const SceneGuest& guest) {
  const FigureStature stature = stature_of(guest);
  BodyFrames frames;
  forward_kinematics(guest.skeleton, guest.pose, frames);
  to_figure(stature, frames);
  const Vector3f base = frames.position(Bone::kHead);
  const Vector3f up = frames.tip(Tip::kHead) - base;
  const Vector3f forward = frames.R_WB[index_of(Bone::kHead)] * Vector3f::UnitZ();
  if (const AvatarModel* model = guest.avatar.get();
      model && model->eyes[0] >= 0 && model->eyes[1] >= 0) {
    const Vector3f eyes =
        0.5f * (rest_place_m(*model, model->eyes[0]) + rest_place_m(*model, model->eyes[1]));
    const Vector3f from_head_m =
        stature.scale * (eyes - rest_place_m(*model, model->node_of(Bone::kHead)));
    const float most_m = kFurthestEyes * stature.body * measures_of(guest.skeleton).body_m;
    if (from_head_m.norm() < most_m) return base + frames.R_WB[index_of(Bone::kHead)] * from_head_m;
  }
  return base + kEyesUp * up + kEyesForward * up.norm() * forward;
}

}  // namespace dance

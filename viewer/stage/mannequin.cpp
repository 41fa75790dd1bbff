#include "viewer/stage/mannequin.h"

#include <algorithm>

#include "viewer/stage/mannequin_builder.h"

namespace dance {

using Eigen::Vector3f;

namespace {
constexpr float kReferenceHeight_m = 1.72f;
constexpr float kShortestPart_m = 1e-3f;
}  // namespace

MannequinBuilder::MannequinBuilder(const SceneGuest& guest, const BodyFrames& frames,
                                   const GuestLook& look, BodyDetail detail, BodyParts& parts)
    : guest_(guest),
      frames_(frames),
      look_(look),
      detail_(detail),
      scale_(std::clamp(standing_height_m(guest.skeleton) / kReferenceHeight_m, 0.3f, 3.0f)),
      parts_(parts),
      skin_{look.skin, 0.18f},
      top_{look.top, 0.06f},
      legs_{look.legs, 0.05f},
      shoes_{look.shoes, 0.45f},
      hair_{look.hair, 0.25f} {}

BodyPart MannequinBuilder::cone(const Vector3f& a_W_m, float radius_a_m, const Vector3f& b_W_m,
                                float radius_b_m, const Vector3f& side_W,
                                const Colour& colour) const {
  BodyPart part;
  part.a_W_m = a_W_m;
  part.b_W_m = b_W_m;
  // The shader takes the axis from the two ends, and a ball has one too.
  if ((b_W_m - a_W_m).norm() < kShortestPart_m)
    part.b_W_m = a_W_m + kShortestPart_m * side_W.unitOrthogonal();
  part.radius_a_m = scale_ * radius_a_m;
  part.radius_b_m = scale_ * radius_b_m;
  part.side_W = side_W;
  part.colour = colour.rgb;
  part.gloss = colour.gloss;
  part.opacity = guest_.opacity;
  return part;
}

void MannequinBuilder::add_torso() {
  const Vector3f hips_x = axis(Bone::kHips, Vector3f::UnitX());
  const Vector3f chest_x = axis(Bone::kUpperChest, Vector3f::UnitX());

  // Waist and ribs share their middle ball, so that the cloth runs through without a step.
  constexpr float kWaistWidth = 1.34f;
  BodyPart pelvis = cone(at(Bone::kHips, {0, -0.045f, 0}), 0.11f, at(Bone::kHips, {0, 0.07f, 0}),
                         0.1f, hips_x, legs_);
  pelvis.width = 1.42f;
  large(pelvis);
  const Vector3f middle = at(Bone::kChest, {0, 0.01f, 0.003f});
  BodyPart waist = cone(at(Bone::kSpine, {0, -0.01f, 0.002f}), 0.096f, middle, 0.099f,
                        axis(Bone::kSpine, Vector3f::UnitX()), top_);
  waist.width = kWaistWidth;
  large(waist);
  BodyPart ribs =
      cone(middle, 0.099f, at(Bone::kUpperChest, {0, 0.03f, 0.006f}), 0.118f, chest_x, top_);
  ribs.width = kWaistWidth;
  large(ribs);
  const Vector3f breastbone = at(Bone::kUpperChest, {0, -0.005f, 0.026f});
  BodyPart breast = cone(breastbone, 0.1f, breastbone, 0.1f, chest_x, top_);
  breast.width = 1.32f;
  large(breast);
  if (look_.legwear != Legwear::kSkirt) {
    BodyPart belt = cone(at(Bone::kHips, {0, 0.085f, 0}), 0.108f, at(Bone::kHips, {0, 0.108f, 0}),
                         0.107f, hips_x, Colour{0.35f * look_.shoes, 0.3f});
    belt.width = 1.34f;
    belt.depth = 0.98f;
    belt.flat_a = belt.flat_b = 0.05f;
    large(belt);
  }

  for (const Side side : {Side::kLeft, Side::kRight}) {
    const float s = sign_of(side);
    const Bone arm = side == Side::kLeft ? Bone::kLeftUpperArm : Bone::kRightUpperArm;
    const Bone leg = side == Side::kLeft ? Bone::kLeftUpperLeg : Bone::kRightUpperLeg;
    const Vector3f shoulder = frames_.position(arm);
    const Vector3f girdle = at(Bone::kUpperChest, {0.045f * s, 0.06f, -0.002f});
    // Ends short of the joint, or its cloth and the arm would lie in one surface and flicker.
    large(cone(girdle, 0.082f, girdle + 0.8f * (shoulder - girdle), 0.058f, chest_x, top_));
    const Vector3f neck = at(Bone::kNeck, {0.008f * s, 0.008f, -0.006f});
    large(cone(neck, 0.049f, neck + 0.8f * (shoulder - neck), 0.036f, chest_x, top_));
    if (look_.legwear != Legwear::kSkirt)
      large(cone(at(leg, {-0.01f * s, 0.02f, -0.022f}), 0.088f, at(leg, {0.0f, -0.06f, -0.012f}),
                 0.087f, hips_x, legs_));
  }
}

void MannequinBuilder::add_skirt() {
  // The hem follows both thighs, so that a wide step spreads the cloth and no knee pierces it.
  const auto along_thigh = [this](Bone upper, Bone lower) -> Vector3f {
    return frames_.position(upper) + 0.86f * (frames_.position(lower) - frames_.position(upper));
  };
  const Vector3f left = along_thigh(Bone::kLeftUpperLeg, Bone::kLeftLowerLeg);
  const Vector3f right = along_thigh(Bone::kRightUpperLeg, Bone::kRightLowerLeg);
  const Vector3f waist = at(Bone::kHips, {0, 0.085f, 0});
  const Vector3f seat = at(Bone::kHips, {0, -0.05f, -0.012f});
  const Vector3f hips_x = axis(Bone::kHips, Vector3f::UnitX());
  const Vector3f apart = left - right;
  const Vector3f side = (apart + 0.2f * scale_ * hips_x).normalized();
  const float half_width_m = 0.5f * apart.norm() / scale_ + 0.13f;
  constexpr float kWidth = 1.18f;
  constexpr float kDepth = 0.93f;
  constexpr float kSeatRadius_m = 0.15f;
  BodyPart yoke = cone(waist, 0.112f, seat, kSeatRadius_m, hips_x, legs_);
  yoke.width = kWidth;
  yoke.depth = kDepth;
  yoke.flat_a = 0.3f;
  large(yoke);
  BodyPart skirt =
      cone(seat, kSeatRadius_m, 0.5f * (left + right), half_width_m / kWidth, side, legs_);
  skirt.width = kWidth;
  skirt.depth = kDepth;
  skirt.flat_b = 0.1f;
  large(skirt);
}

void MannequinBuilder::add_contact_spots() {
  // Falls off with the height of the thing over the floor; the half heights are chosen by eye.
  const auto spot = [this](const Vector3f& over_W_m, const Vector3f& along_W, float half_length_m,
                           float half_width_m, float half_height_m, float darkness) {
    const float height = std::max(0.0f, over_W_m.y()) / (scale_ * half_height_m);
    Vector3f along(along_W.x(), 0.0f, along_W.z());
    if (along.squaredNorm() < 1e-4f) along = Vector3f::UnitX();
    const float spread = 1.0f + 0.6f * std::min(height, 2.0f);
    parts_.spots.push_back({Vector3f(over_W_m.x(), 0.0f, over_W_m.z()),
                            scale_ * half_length_m * spread, along.normalized(),
                            scale_ * half_width_m * spread,
                            guest_.opacity * darkness / (1.0f + height * height)});
  };
  for (const auto& [foot, toes] : {std::pair{Bone::kLeftFoot, Bone::kLeftToes},
                                   std::pair{Bone::kRightFoot, Bone::kRightToes}}) {
    const Vector3f heel = frames_.position(foot);
    const Vector3f ball = frames_.position(toes);
    Vector3f middle = 0.45f * heel + 0.55f * ball;
    middle.y() = std::min(heel.y() - 0.08f * scale_, ball.y() - 0.02f * scale_);
    spot(middle, ball - heel, 0.24f, 0.13f, 0.06f, 0.62f);
  }
  const Vector3f hips = frames_.position(Bone::kHips);
  spot(hips, axis(Bone::kHips, Vector3f::UnitX()), 0.42f, 0.36f, 0.9f, 0.42f);
}

void append_mannequin(const SceneGuest& guest, BodyDetail detail, BodyParts& parts) {
  BodyFrames frames;
  forward_kinematics(guest.skeleton, guest.pose, frames);
  const GuestLook look = look_of(guest.id);
  MannequinBuilder builder(guest, frames, look, detail, parts);
  builder.add_torso();
  builder.add_head();
  for (const Side side : {Side::kLeft, Side::kRight}) {
    builder.add_arm(side);
    builder.add_hand(side);
    builder.add_leg(side);
  }
  if (look.legwear == Legwear::kSkirt) builder.add_skirt();
  builder.add_contact_spots();
}

}  // namespace dance

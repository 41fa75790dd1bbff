#include "viewer/figure/rig/avatar_rig.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/pose/shortest_turn.h"
#include "formats/body/hand_layout.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kShortestBone_m = 1e-3f;
constexpr float kOwnBody_m = 1e-4f;
constexpr float kShoesOff_m = 4e-3f;
constexpr float kPalmShare = 0.8f;  // of the way from the wrist to where the middle finger begins
// Where toes bend, for feet without: a share of the way from the ankle to the tip.
constexpr float kBallShare = 0.7f;

Quaternionf turn(const Vector3f& from, const Vector3f& to) {
  if (from.norm() < 1e-6f || to.norm() < 1e-6f) return Quaternionf::Identity();
  return shortest_turn(from.cast<double>(), to.cast<double>()).cast<float>().normalized();
}

bool is_left(Bone bone) {
  return bone >= Bone::kLeftShoulder &&
         (bone <= Bone::kLeftHand || (bone >= Bone::kLeftUpperLeg && bone <= Bone::kLeftToes));
}

// The nearest bone above that the avatar has.
std::size_t parent_of(const AvatarShape& shape, std::size_t bone) {
  int up = kBones[bone].parent;
  while (up > 0 && !shape.has_bone[static_cast<std::size_t>(up)])
    up = kBones[static_cast<std::size_t>(up)].parent;
  return static_cast<std::size_t>(std::max(up, 0));
}

Vector3f direction_or(const Vector3f& offset_m, const Vector3f& usual) {
  return offset_m.norm() > kShortestBone_m ? offset_m : usual;
}

// Twist about `axis` that brings `from` as near to `to` as it can.
Quaternionf twist_to(const Vector3f& axis, const Vector3f& from, const Vector3f& to) {
  const Vector3f a = from - axis * axis.dot(from), b = to - axis * axis.dot(to);
  if (a.norm() < 1e-4f || b.norm() < 1e-4f) return Quaternionf::Identity();
  return Quaternionf(Eigen::AngleAxisf(std::atan2(axis.dot(a.cross(b)), a.dot(b)), axis));
}

void correct_arm(const AvatarShape& shape, const Skeleton& dancer, const HandLayout& layout,
                 const Limb& arm, BoneRotations& C) {
  const bool left = is_left(arm.upper);
  const Vector3f outward = Vector3f(left ? 1.0f : -1.0f, 0.0f, 0.0f);
  const std::size_t upper = index_of(arm.upper), lower = index_of(arm.lower),
                    hand = index_of(arm.end);
  C[upper] = turn(shape.at(arm.lower) - shape.at(arm.upper),
                  direction_or(dancer.offset(arm.lower), outward));
  C[lower] = turn(C[upper] * (shape.at(arm.end) - shape.at(arm.lower)),
                  direction_or(dancer.offset(arm.end), outward)) *
             C[upper];
  C[hand] = C[lower];
  const std::size_t first = left ? 0 : kFingerBoneCount / 2;
  const std::size_t index = first + 3, middle = first + 6, little = first + 12;
  if (!shape.has_finger[middle]) return;
  const auto finger = [&](std::size_t f) { return shape.drivers_M_m[kFirstFingerDriver + f]; };
  const Vector3f along = layout.offset_m[middle].normalized();
  C[hand] = turn(C[lower] * (finger(middle) - shape.at(arm.end)), along) * C[lower];
  if (!shape.has_finger[index] || !shape.has_finger[little]) return;
  const Vector3f across = C[hand] * (finger(index) - finger(little));
  C[hand] = twist_to(along, across, layout.offset_m[index] - layout.offset_m[little]) * C[hand];
}

void correct_leg(const AvatarShape& shape, const Skeleton& dancer, const Limb& leg, Bone toes,
                 BoneRotations& C) {
  const std::size_t upper = index_of(leg.upper), lower = index_of(leg.lower),
                    foot = index_of(leg.end);
  C[upper] = turn(shape.at(leg.lower) - shape.at(leg.upper),
                  direction_or(dancer.offset(leg.lower), -Vector3f::UnitY()));
  C[lower] = turn(C[upper] * (shape.at(leg.end) - shape.at(leg.lower)),
                  direction_or(dancer.offset(leg.end), -Vector3f::UnitY())) *
             C[upper];
  // A foot at rest is flat on its sole, however its bone slopes: only where it points is corrected.
  Vector3f points =
      shape.has(toes) ? Vector3f(shape.at(toes) - shape.at(leg.end)) : Vector3f(Vector3f::UnitZ());
  Vector3f wanted = shape.has(toes) ? dancer.offset(toes) : Vector3f(Vector3f::UnitZ());
  points.y() = wanted.y() = 0.0f;
  constexpr float kLeastLength = 0.02f;  // of the height: else it has no direction
  if (points.norm() > kLeastLength * shape.height_m && wanted.norm() > 0.02f)
    C[foot] = twist_to(Vector3f::UnitY(), points, wanted);
  C[index_of(toes)] = C[foot];
}

FootPoints dancer_foot(const Skeleton& dancer, std::size_t side) {
  const Bone upper = side == 0 ? Bone::kLeftUpperLeg : Bone::kRightUpperLeg;
  const Bone toes = side == 0 ? Bone::kLeftToes : Bone::kRightToes;
  const Vector3f& to_toes = dancer.offset(toes);
  const Vector3f& to_tip = dancer.tip(side == 0 ? Tip::kLeftToes : Tip::kRightToes);
  float ankle_m = dancer.hips_height_m();
  for (std::size_t b = index_of(upper); b < index_of(toes); ++b) ankle_m += dancer.offset_m[b].y();
  ankle_m = std::max(ankle_m, 0.0f);
  const float length = std::hypot(to_toes.x(), to_toes.z()) + std::hypot(to_tip.x(), to_tip.z());
  const float half = 0.15f * length;
  FootPoints points;
  points.ball_m = Vector3f(to_toes.x(), -ankle_m, to_toes.z());
  points.tip_m = Vector3f(to_tip.x(), -ankle_m - to_toes.y(), to_tip.z());
  for (const float side_m : {-half, half}) {
    points.lowest.foot_m[points.lowest.foot_count++] = Vector3f(side_m, -ankle_m, -0.25f * length);
    points.lowest.foot_m[points.lowest.foot_count++] = points.ball_m + side_m * Vector3f::UnitX();
  }
  points.lowest.toes_m[points.lowest.toes_count++] = points.tip_m;
  return points;
}

FootPoints avatar_foot(const AvatarShape& shape, const Quaternionf& C, float scale,
                       std::size_t side) {
  const Bone foot = side == 0 ? Bone::kLeftFoot : Bone::kRightFoot;
  const Bone toes = side == 0 ? Bone::kLeftToes : Bone::kRightToes;
  const SoleShape& sole = shape.soles[side];
  const Vector3f& ankle = shape.at(foot);
  const bool has_toes = shape.has(toes);
  const float ball_z =
      has_toes ? shape.at(toes).z() : ankle.z() + kBallShare * (sole.tip_m - ankle.z());
  const float middle = 0.5f * (sole.inner_m + sole.outer_m);
  const auto from = [&](const Vector3f& origin, const Vector3f& place) {
    return Vector3f(scale * (C * (place - origin)));
  };
  const Vector3f& toes_origin = has_toes ? shape.at(toes) : ankle;
  FootPoints points;
  points.ball_m = from(ankle, Vector3f(middle, sole.floor_m, ball_z));
  points.tip_m = from(toes_origin, Vector3f(middle, sole.floor_m, sole.tip_m));
  const SoleHull& hull = shape.hulls[side];
  points.lowest.foot_count = hull.foot_count;
  points.lowest.toes_count = hull.toes_count;
  for (std::size_t i = 0; i < hull.foot_count; ++i)
    points.lowest.foot_m[i] = from(ankle, hull.foot_m[i]);
  for (std::size_t i = 0; i < hull.toes_count; ++i)
    points.lowest.toes_m[i] = from(toes_origin, hull.toes_m[i]);
  if (hull.foot_count + hull.toes_count > 0) return points;
  for (const float x : {sole.inner_m, sole.outer_m})
    for (const float z : {sole.heel_m, ball_z})
      points.lowest.foot_m[points.lowest.foot_count++] = from(ankle, Vector3f(x, sole.floor_m, z));
  points.lowest.toes_m[points.lowest.toes_count++] = points.tip_m;
  return points;
}

float leg_height_m(const Skeleton& dancer) {
  const float aside =
      0.5f * (dancer.offset(Bone::kLeftUpperLeg).y() + dancer.offset(Bone::kRightUpperLeg).y());
  return std::max(dancer.hips_height_m() + aside, 0.05f);
}

// With straightened legs, as they are in the dancer's T-pose.
float leg_height_m(const AvatarShape& shape, const BoneRotations& C) {
  float sum = 0.0f;
  for (std::size_t side = 0; side < 2; ++side) {
    const Limb& leg = side == 0 ? kLeftLeg : kRightLeg;
    const Vector3f thigh = C[index_of(leg.upper)] * (shape.at(leg.lower) - shape.at(leg.upper));
    const Vector3f shank = C[index_of(leg.lower)] * (shape.at(leg.end) - shape.at(leg.lower));
    sum += shape.at(leg.end).y() - shape.soles[side].floor_m - thigh.y() - shank.y();
  }
  return std::max(0.5f * sum, 0.01f * shape.height_m);
}

float shoulder_width_m(const Skeleton& body) {
  const Vector3f across = body.offset(Bone::kLeftShoulder) + body.offset(Bone::kLeftUpperArm) -
                          body.offset(Bone::kRightShoulder) - body.offset(Bone::kRightUpperArm);
  return std::max(across.norm(), 0.05f);
}

Skeleton skeleton_of(const AvatarShape& shape, const BoneRotations& C, float scale,
                     const std::array<FootPoints, 2>& feet) {
  Skeleton body;
  body.offset_m[0] = Vector3f(0.0f, leg_height_m(shape, C) * scale, 0.0f);
  for (std::size_t b = 1; b < kBoneCount; ++b) {
    body.offset_m[b].setZero();
    if (!shape.has_bone[b]) continue;
    const std::size_t parent = parent_of(shape, b);
    body.offset_m[b] = scale * (C[parent] * (shape.drivers_M_m[b] - shape.drivers_M_m[parent]));
  }
  body.tip_m[0] = Vector3f(0.0f, shape.crown_m * scale, 0.0f);
  for (std::size_t side = 0; side < 2; ++side) {
    const Bone hand = side == 0 ? Bone::kLeftHand : Bone::kRightHand;
    body.tip_m[1 + side] =
        2.0f * scale * (C[index_of(hand)] * (shape.hand_ends_M_m[side] - shape.at(hand)));
    body.tip_m[3 + side] = feet[side].tip_m;
  }
  return body;
}

// Whether bones lie as the dancer's own do.
bool is_alike(const Skeleton& a, const Skeleton& b) {
  for (std::size_t i = 1; i < kBoneCount; ++i)
    if ((a.offset_m[i] - b.offset_m[i]).cwiseAbs().maxCoeff() > kOwnBody_m) return false;
  return true;
}

void correct_fingers(const AvatarShape& shape, const HandLayout& layout, AvatarRig& rig) {
  for (std::size_t f = 0; f < kFingerBoneCount; ++f) {
    const std::size_t hand = index_of(hand_of_finger_bone(f));
    const int above = kFingerBones[f].parent;
    std::size_t leader = hand;
    for (int up = above; up >= 0; up = kFingerBones[static_cast<std::size_t>(up)].parent)
      if (shape.has_finger[static_cast<std::size_t>(up)]) {
        leader = kFirstFingerDriver + static_cast<std::size_t>(up);
        break;
      }
    rig.finger_leaders[f] = leader;
    rig.C_finger[f] = above < 0 ? rig.C[hand] : rig.C_finger[static_cast<std::size_t>(above)];
    const bool is_last = f % kBonesOfAFinger + 1 == kBonesOfAFinger;
    if (!shape.has_finger[f] || is_last || !shape.has_finger[f + 1]) continue;
    const Vector3f bone =
        shape.drivers_M_m[kFirstFingerDriver + f + 1] - shape.drivers_M_m[kFirstFingerDriver + f];
    rig.C_finger[f] = turn(rig.C_finger[f] * bone, layout.offset_m[f + 1]) * rig.C_finger[f];
  }
}

}  // namespace

AvatarRig::AvatarRig(std::shared_ptr<const AvatarShape> shape_of_model, const Skeleton& dancer,
                     FigureSize size, float height_scale)
    : shape(std::move(shape_of_model)) {
  const HandLayout layout = hand_layout(dancer);
  correct_arm(*shape, dancer, layout, kLeftArm, C);
  correct_arm(*shape, dancer, layout, kRightArm, C);
  correct_leg(*shape, dancer, kLeftLeg, Bone::kLeftToes, C);
  correct_leg(*shape, dancer, kRightLeg, Bone::kRightToes, C);
  const float dancer_leg = leg_height_m(dancer), own_leg = leg_height_m(*shape, C);
  scale = size == FigureSize::kOwn ? 1.0f : dancer_leg / own_leg;
  if (std::isfinite(height_scale))
    scale *= std::clamp(height_scale, kLeastHeightScale, kMostHeightScale);
  leg_ratio = scale * own_leg / dancer_leg;
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t foot = index_of(side == 0 ? Bone::kLeftFoot : Bone::kRightFoot);
    const std::size_t hand = index_of(side == 0 ? Bone::kLeftHand : Bone::kRightHand);
    feet[side] = avatar_foot(*shape, C[foot], scale, side);
    dancer_feet[side] = dancer_foot(dancer, side);
    const std::size_t middle = side * kFingerBoneCount / 2 + 6;
    dancer_palms_m[side] = kPalmShare * layout.offset_m[middle];
    palms_m[side] =
        kPalmShare * scale * (C[hand] * (shape->hand_ends_M_m[side] - shape->drivers_M_m[hand]));
  }
  body = skeleton_of(*shape, C, scale, feet);
  girth_ratio = std::clamp(shoulder_width_m(body) / shoulder_width_m(dancer), 0.5f, 2.0f);
  correct_fingers(*shape, layout, *this);
  // A dancer in the own mannequin's body is shown as danced, but for soles near the floor.
  if (std::abs(height_scale - 1.0f) < 1e-6f &&
      is_alike(skeleton_of(*shape, C, 1.0f, feet), dancer)) {
    is_own_body = true;
    scale = leg_ratio = girth_ratio = 1.0f;
    body = dancer;
    palms_m = dancer_palms_m;
    for (std::size_t side = 0; side < 2; ++side) {
      // The dancer's floor is the skeleton's; shoes of the mesh are a millimetre or two off.
      const FootPoints& own = dancer_feet[side];
      SoleHull& hull = feet[side].lowest;
      float low = 1e9f;
      for (std::size_t i = 0; i < hull.foot_count; ++i) low = std::min(low, hull.foot_m[i].y());
      for (std::size_t i = 0; i < hull.toes_count; ++i)
        low = std::min(low, hull.toes_m[i].y() + dancer.offset_m[toes_of(side)].y());
      const float up = own.ball_m.y() - low;
      feet[side].ball_m = own.ball_m;
      feet[side].tip_m = own.tip_m;
      if (std::abs(up) > kShoesOff_m) continue;
      for (Vector3f& point : hull.foot_m) point.y() += up;
      for (Vector3f& point : hull.toes_m) point.y() += up;
    }
    dancer_feet = feet;
  }
  const std::size_t head = index_of(Bone::kHead);
  eyes_m = scale * (C[head] * (shape->eyes_M_m - shape->drivers_M_m[head]));
}

void AvatarRig::fold(Pose& pose) const {
  auto& R = pose.R_PB;
  const AvatarShape& has = *shape;
  const auto into = [&](Bone from, Bone to) {  // the child takes over what its parent turned
    R[index_of(to)] = R[index_of(from)] * R[index_of(to)];
  };
  const auto done = [&](Bone bone) { R[index_of(bone)].setIdentity(); };
  // Of the back: a turn goes to the next lower bone of the back, else to the next higher, else to
  // what the back carries.
  constexpr std::array<Bone, 3> kBack{Bone::kUpperChest, Bone::kChest, Bone::kSpine};
  for (std::size_t i = 0; i < kBack.size(); ++i) {
    const Bone bone = kBack[i];
    if (has.has(bone)) continue;
    const auto lower = std::ranges::find_if(kBack.begin() + i + 1, kBack.end(),
                                            [&](Bone it) { return has.has(it); });
    if (lower != kBack.end()) {
      const Bone next = kBack[i + 1];  // itself folded in its turn, if it is missing
      R[index_of(next)] = R[index_of(next)] * R[index_of(bone)];
    } else if (i > 0 && (has.has(kBack[i - 1]) || (i > 1 && has.has(kBack[0])))) {
      into(bone, has.has(kBack[i - 1]) ? kBack[i - 1] : kBack[0]);
    } else {
      for (const Bone child : {Bone::kNeck, Bone::kLeftShoulder, Bone::kRightShoulder})
        into(bone, child);
    }
    done(bone);
  }
  constexpr std::array<std::pair<Bone, Bone>, 3> kPassedOn{
      {{Bone::kNeck, Bone::kHead},
       {Bone::kLeftShoulder, Bone::kLeftUpperArm},
       {Bone::kRightShoulder, Bone::kRightUpperArm}}};
  for (const auto& [bone, child] : kPassedOn)
    if (!has.has(bone)) {
      into(bone, child);
      done(bone);
    }
  // A foot of one piece rolls on half as far as toes would let it.
  constexpr std::array<std::pair<Bone, Bone>, 2> kToes{
      {{Bone::kLeftToes, Bone::kLeftFoot}, {Bone::kRightToes, Bone::kRightFoot}}};
  for (const auto& [toes, foot] : kToes)
    if (!has.has(toes)) {
      R[index_of(foot)] =
          R[index_of(foot)] * Quaternionf::Identity().slerp(0.5f, R[index_of(toes)]);
      done(toes);
    }
}

}  // namespace dance

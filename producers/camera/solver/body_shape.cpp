#include "producers/camera/solver/body_shape.h"

#include <algorithm>

namespace dance {

using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

constexpr double kReference_m = 1.72;
// The network's heel and toe, from the ankle of a foot whose ankle is 8 cm above the floor: both
// lie within the shoe, the heel nearly below the ankle. Medians over a video of a man in shoes.
constexpr double kAnkle_m = 0.08, kHeelY_m = -0.045, kHeelZ_m = 0.014, kFoot_m = 0.146;
// A foot's heel is behind its ankle by this share of what its toes are before it.
constexpr double kBehind = 0.24;
// Of neck and head to those of an average body.
constexpr double kMostHeadRatio = 1.35;

double& length(BodyLengths& lengths, Length which) {
  return lengths[static_cast<std::size_t>(which)];
}
double length(const BodyLengths& lengths, Length which) {
  return lengths[static_cast<std::size_t>(which)];
}

// Of a head whose ears are 15 cm apart, from the head's bone; left side.
struct HeadPoint {
  Landmark left, right;
  double x, y, z;
};
constexpr HeadPoint kHeadPoints[]{
    {Landmark::kNose, Landmark::kNose, 0.0, 0.065, 0.115},
    {Landmark::kLeftEyeInner, Landmark::kRightEyeInner, 0.018, 0.1, 0.092},
    {Landmark::kLeftEye, Landmark::kRightEye, 0.032, 0.1, 0.088},
    {Landmark::kLeftEyeOuter, Landmark::kRightEyeOuter, 0.046, 0.1, 0.08},
    {Landmark::kLeftEar, Landmark::kRightEar, 0.075, 0.08, 0.005},
    {Landmark::kMouthLeft, Landmark::kMouthRight, 0.025, 0.03, 0.098},
};
constexpr double kEars_m = 0.15;

// Of a hand whose wrist-to-tip is 18.5 cm, palm down, thumb forward; left side.
struct HandPoint {
  Landmark left, right;
  double x, y, z;
};
constexpr HandPoint kHandPoints[]{
    {Landmark::kLeftPinky, Landmark::kRightPinky, 0.08, 0.0, -0.035},
    {Landmark::kLeftIndex, Landmark::kRightIndex, 0.092, 0.0, 0.025},
    {Landmark::kLeftThumb, Landmark::kRightThumb, 0.055, -0.012, 0.05},
};

void put(BodyShape& shape, Landmark landmark, const Vector3d& place) {
  shape.point_m[point_of(landmark)] = place;
}

void place_points(BodyShape& shape, const BodyLengths& lengths) {
  const double head = length(lengths, Length::kEars) / kEars_m;
  for (const HeadPoint& p : kHeadPoints) {
    put(shape, p.left, head * Vector3d(p.x, p.y, p.z));
    put(shape, p.right, head * Vector3d(-p.x, p.y, p.z));
  }
  const double hand = static_cast<double>(shape.skeleton.tip(Tip::kLeftHand).x()) / 0.185;
  for (const HandPoint& p : kHandPoints) {
    put(shape, p.left, hand * Vector3d(p.x, p.y, p.z));
    put(shape, p.right, hand * Vector3d(-p.x, p.y, p.z));
  }
  for (const Landmark at_joint :
       {Landmark::kLeftShoulder, Landmark::kRightShoulder, Landmark::kLeftElbow,
        Landmark::kRightElbow, Landmark::kLeftWrist, Landmark::kRightWrist, Landmark::kLeftHip,
        Landmark::kRightHip, Landmark::kLeftKnee, Landmark::kRightKnee, Landmark::kLeftAnkle,
        Landmark::kRightAnkle})
    put(shape, at_joint, Vector3d::Zero());
  const Vector3d toes = shape.skeleton.offset(Bone::kLeftToes).cast<double>();
  const Vector3d tip = shape.skeleton.tip(Tip::kLeftToes).cast<double>();
  const double floor_y = toes.y() + tip.y();
  const double foot = length(lengths, Length::kFoot) / kFoot_m;
  const double up = -floor_y / kAnkle_m;
  for (const Landmark heel : {Landmark::kLeftHeel, Landmark::kRightHeel})
    put(shape, heel, {0.0, up * kHeelY_m, foot * kHeelZ_m});
  for (const Landmark toe : {Landmark::kLeftFootIndex, Landmark::kRightFootIndex})
    put(shape, toe, Vector3d(0.0, up * kHeelY_m, foot * (kHeelZ_m + kFoot_m)) - toes);
  // The body's own heel lies behind the network's heel point.
  const double heel_z = -kBehind * (toes.z() + tip.z());
  for (const Sole heel : {Sole::kLeftHeel, Sole::kRightHeel})
    shape.point_m[point_of(heel)] = {0.0, floor_y, heel_z};
  for (const Sole ball : {Sole::kLeftBall, Sole::kRightBall})
    shape.point_m[point_of(ball)] = {0.0, floor_y, toes.z()};
}

}  // namespace

Bone bone_of(std::size_t body_point) {
  static constexpr std::array<Bone, kBodyPointCount> kBonesOfPoints = [] {
    std::array<Bone, kBodyPointCount> bones{};
    for (std::size_t i = 0; i <= index_of(Landmark::kMouthRight); ++i) bones[i] = Bone::kHead;
    const auto pair = [&bones](Landmark left, Bone on_left, Bone on_right) {
      bones[index_of(left)] = on_left;
      bones[index_of(left) + 1] = on_right;
    };
    pair(Landmark::kLeftShoulder, Bone::kLeftUpperArm, Bone::kRightUpperArm);
    pair(Landmark::kLeftElbow, Bone::kLeftLowerArm, Bone::kRightLowerArm);
    for (const Landmark of_hand :
         {Landmark::kLeftWrist, Landmark::kLeftPinky, Landmark::kLeftIndex, Landmark::kLeftThumb})
      pair(of_hand, Bone::kLeftHand, Bone::kRightHand);
    pair(Landmark::kLeftHip, Bone::kLeftUpperLeg, Bone::kRightUpperLeg);
    pair(Landmark::kLeftKnee, Bone::kLeftLowerLeg, Bone::kRightLowerLeg);
    pair(Landmark::kLeftAnkle, Bone::kLeftFoot, Bone::kRightFoot);
    pair(Landmark::kLeftHeel, Bone::kLeftFoot, Bone::kRightFoot);
    pair(Landmark::kLeftFootIndex, Bone::kLeftToes, Bone::kRightToes);
    bones[point_of(Sole::kLeftHeel)] = bones[point_of(Sole::kLeftBall)] = Bone::kLeftFoot;
    bones[point_of(Sole::kRightHeel)] = bones[point_of(Sole::kRightBall)] = Bone::kRightFoot;
    return bones;
  }();
  return kBonesOfPoints[body_point];
}

BodyLengths average_lengths(double height_m) {
  const Skeleton average = average_skeleton(static_cast<float>(kReference_m));
  const auto of = [&average](Bone bone) { return average.offset(bone).cast<double>(); };
  const Vector3d shoulder = of(Bone::kSpine) + of(Bone::kChest) + of(Bone::kUpperChest) +
                            of(Bone::kLeftShoulder) + of(Bone::kLeftUpperArm);
  const Vector3d hip = of(Bone::kLeftUpperLeg);
  BodyLengths lengths{};
  length(lengths, Length::kShoulders) = 2.0 * shoulder.x();
  length(lengths, Length::kHips) = 2.0 * hip.x();
  length(lengths, Length::kTorso) = (shoulder - hip).tail<2>().norm();
  length(lengths, Length::kUpperArm) = of(Bone::kLeftLowerArm).norm();
  length(lengths, Length::kLowerArm) = of(Bone::kLeftHand).norm();
  length(lengths, Length::kThigh) = of(Bone::kLeftLowerLeg).norm();
  length(lengths, Length::kShank) = of(Bone::kLeftFoot).norm();
  length(lengths, Length::kFoot) = kFoot_m;
  length(lengths, Length::kEars) = kEars_m;
  for (double& l : lengths) l *= height_m / kReference_m;
  return lengths;
}

double height_of(const BodyLengths& lengths) {
  // foot + shank + thigh + torso, all upright, and a neck and head that are a share of the whole.
  const BodyLengths average = average_lengths(1.0);
  const auto tall = [](const BodyLengths& l) {
    return length(l, Length::kThigh) + length(l, Length::kShank) + length(l, Length::kTorso);
  };
  return tall(lengths) / tall(average);
}

BodyShape shape_of(const BodyLengths& lengths) {
  const double height = height_of(lengths);
  const BodyLengths average = average_lengths(height);
  BodyShape shape;
  shape.skeleton = average_skeleton(static_cast<float>(height));
  auto& offset = shape.skeleton.offset_m;
  const auto ratio = [&](Length which) {
    return static_cast<float>(length(lengths, which) / length(average, which));
  };
  const auto scale = [&offset](std::initializer_list<Bone> bones, float by) {
    for (const Bone bone : bones) offset[index_of(bone)] *= by;
  };
  // What lies above and below the two hip joints.
  const float hips_drop = offset[index_of(Bone::kLeftUpperLeg)].y();
  scale({Bone::kSpine, Bone::kChest, Bone::kUpperChest}, ratio(Length::kTorso));
  for (const Bone bone : {Bone::kLeftUpperLeg, Bone::kRightUpperLeg}) {
    offset[index_of(bone)].x() *= ratio(Length::kHips);
    offset[index_of(bone)].y() = hips_drop * ratio(Length::kTorso);
  }
  for (const Bone bone : {Bone::kLeftShoulder, Bone::kRightShoulder}) {
    offset[index_of(bone)].x() *= ratio(Length::kShoulders);
    offset[index_of(bone)].y() *= ratio(Length::kTorso);
  }
  for (const Bone bone : {Bone::kLeftUpperArm, Bone::kRightUpperArm})
    offset[index_of(bone)].x() *= ratio(Length::kShoulders);
  scale({Bone::kLeftLowerArm, Bone::kRightLowerArm}, ratio(Length::kUpperArm));
  scale({Bone::kLeftHand, Bone::kRightHand}, ratio(Length::kLowerArm));
  scale({Bone::kLeftLowerLeg, Bone::kRightLowerLeg}, ratio(Length::kThigh));
  scale({Bone::kLeftFoot, Bone::kRightFoot}, ratio(Length::kShank));
  const float foot = ratio(Length::kFoot);
  for (const Bone bone : {Bone::kLeftToes, Bone::kRightToes}) offset[index_of(bone)].z() *= foot;
  for (const Tip tip : {Tip::kLeftToes, Tip::kRightToes})
    shape.skeleton.tip_m[static_cast<std::size_t>(tip)].z() *= foot;
  // Legs straight, soles on the floor.
  offset[0].y() =
      -(offset[index_of(Bone::kLeftUpperLeg)].y() + offset[index_of(Bone::kLeftLowerLeg)].y() +
        offset[index_of(Bone::kLeftFoot)].y() + offset[index_of(Bone::kLeftToes)].y() +
        shape.skeleton.tip(Tip::kLeftToes).y());
  place_points(shape, lengths);
  return shape;
}

BodyShape shape_of(const BodyLengths& lengths, double stature_m) {
  BodyShape shape = shape_of(lengths);
  auto& offset = shape.skeleton.offset_m;
  float& crown = shape.skeleton.tip_m[static_cast<std::size_t>(Tip::kHead)].y();
  float& neck = offset[index_of(Bone::kNeck)].y();
  float& head = offset[index_of(Bone::kHead)].y();
  const double above_m = static_cast<double>(neck + head + crown);
  const double missing_m = stature_m - static_cast<double>(standing_height_m(shape.skeleton));
  const auto by = static_cast<float>(
      std::clamp(1.0 + missing_m / above_m, 1.0 / kMostHeadRatio, kMostHeadRatio));
  for (float* length_m : {&neck, &head, &crown}) *length_m *= by;
  return shape;
}

}  // namespace dance

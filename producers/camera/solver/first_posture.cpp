#include "producers/camera/solver/first_posture.h"

#include <algorithm>
#include <cmath>

#include "core/pose/shortest_turn.h"
#include "producers/camera/solver/body_fit.h"

namespace dance {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

constexpr double kSeenEnough = 0.1;
// Cosine of how far a bone may be off: 40 degrees.
constexpr double kFarLimb = 0.766;

// The frame with y along `up` and x as near to `across` as that allows.
Quaterniond frame_of(const Vector3d& across, const Vector3d& up) {
  Matrix3d m;
  m.col(1) = up.normalized();
  const Vector3d forward = across.cross(m.col(1));
  if (!(forward.norm() > 1e-6)) return shortest_turn(Vector3d::UnitY(), up);
  m.col(2) = forward.normalized();
  m.col(0) = m.col(1).cross(m.col(2));
  return Quaterniond(m);
}

struct Directions {
  const Observation& seen;
  const Matrix3d& R_WC;

  bool sees(Landmark l) const { return seen.world_weight[index_of(l)] > kSeenEnough; }
  Vector3d at(Landmark l) const { return R_WC * seen.world(l); }
  Vector3d middle(Landmark left) const {
    return 0.5 * (at(left) + R_WC * seen.world_m[index_of(left) + 1]);
  }
};

Landmark of_side(Landmark left, std::size_t s) { return static_cast<Landmark>(index_of(left) + s); }

// The bone that lies along `rest` in T-pose and turns its next joint about `hinge`, where the next
// bone goes on along `next`.
Quaterniond limb_turn(const Vector3d& rest, const Vector3d& hinge, const Vector3d& along,
                      const Vector3d& bent_hinge, const Quaterniond& R_WParent) {
  const Quaterniond R_PW = R_WParent.conjugate();
  const Vector3d direction = R_PW * along.normalized();
  const Quaterniond short_way = shortest_turn(rest, direction);
  // Twist: by how much the hinge has to turn about the bone to be where it is seen. A nearly
  // straight limb leaves it undetermined.
  const double sine = bent_hinge.norm();
  if (sine < 0.15) return short_way;
  const Vector3d wanted = R_PW * bent_hinge / sine;
  const Vector3d has = short_way * hinge;
  const double twist = std::atan2(direction.dot(has.cross(wanted)), has.dot(wanted));
  return Quaterniond(Eigen::AngleAxisd(twist, direction)) * short_way;
}

void place_arm(const Directions& look, std::size_t s, const BodyShape& shape,
               const Quaterniond& R_WChest, BodyState::Side& side) {
  const Landmark shoulder = of_side(Landmark::kLeftShoulder, s),
                 elbow = of_side(Landmark::kLeftElbow, s), wrist = of_side(Landmark::kLeftWrist, s);
  if (!look.sees(shoulder) || !look.sees(elbow)) return;
  const double sign = s == 0 ? 1.0 : -1.0;
  const Vector3d upper = look.at(elbow) - look.at(shoulder);
  if (upper.norm() < 1e-3) return;
  Vector3d lower = look.sees(wrist) ? Vector3d(look.at(wrist) - look.at(elbow)) : upper;
  if (lower.norm() < 1e-3) lower = upper;
  // An elbow bends about −y of the left arm, +y of the right one.
  const Vector3d hinge(0.0, -sign, 0.0);
  side.upper_arm = limb_turn(shape.skeleton.offset(Bone::kLeftLowerArm)
                                 .cast<double>()
                                 .cwiseProduct(Vector3d(sign, 1.0, 1.0)),
                             hinge, upper, upper.normalized().cross(lower.normalized()), R_WChest);
  side.elbow = std::acos(std::clamp(upper.normalized().dot(lower.normalized()), -1.0, 1.0));
  side.elbow = std::min(side.elbow, kMostElbow_rad);
  const Landmark index = of_side(Landmark::kLeftIndex, s), pinky = of_side(Landmark::kLeftPinky, s);
  if (!look.sees(index) || !look.sees(pinky) || !look.sees(wrist)) return;
  // The knuckles lie along +z of the hand.
  const Quaterniond R_WFore =
      R_WChest * side.upper_arm * Quaterniond(Eigen::AngleAxisd(side.elbow, hinge));
  const Vector3d across = R_WFore.conjugate() * (look.at(index) - look.at(pinky));
  if (across.tail<2>().norm() > 1e-3)
    side.turn = std::clamp(std::atan2(-across.y(), across.z()), -1.6, 1.6);
}

void place_leg(const Directions& look, std::size_t s, const Quaterniond& R_WHips,
               BodyState::Side& side) {
  const Landmark hip = of_side(Landmark::kLeftHip, s), knee = of_side(Landmark::kLeftKnee, s),
                 ankle = of_side(Landmark::kLeftAnkle, s), heel = of_side(Landmark::kLeftHeel, s),
                 toe = of_side(Landmark::kLeftFootIndex, s);
  if (!look.sees(hip) || !look.sees(knee)) return;
  const Vector3d thigh = look.at(knee) - look.at(hip);
  if (thigh.norm() < 1e-3) return;
  Vector3d shank = look.sees(ankle) ? Vector3d(look.at(ankle) - look.at(knee)) : thigh;
  if (shank.norm() < 1e-3) shank = thigh;
  Vector3d hinge = thigh.normalized().cross(shank.normalized());
  const bool sees_foot = look.sees(heel) && look.sees(toe) && look.sees(ankle);
  const Vector3d foot = sees_foot ? Vector3d(look.at(toe) - look.at(heel)) : Vector3d::Zero();
  // A straight knee bends in the plane of the foot; a hinge that points the other way is noise.
  if (foot.norm() > 1e-3) {
    const Vector3d of_foot = foot.normalized().cross(thigh.normalized());
    if (hinge.norm() < 0.25 || hinge.dot(of_foot) < 0.0) hinge = of_foot;
  }
  side.upper_leg = limb_turn(-Vector3d::UnitY(), Vector3d::UnitX(), thigh, hinge, R_WHips);
  side.knee = std::min(std::acos(std::clamp(thigh.normalized().dot(shank.normalized()), -1.0, 1.0)),
                       kMostKnee_rad);
  if (foot.norm() < 1e-3) return;
  const Quaterniond R_WShank =
      R_WHips * side.upper_leg * Quaterniond(Eigen::AngleAxisd(side.knee, Vector3d::UnitX()));
  const Vector3d in_shank = R_WShank.conjugate() * foot.normalized();
  side.foot = shortest_turn(Vector3d::UnitZ(), in_shank);
}

}  // namespace

BodyState first_posture(const Observation& seen, const BodyShape& shape, const Matrix3d& R_WC) {
  const Directions look{seen, R_WC};
  BodyState state = state_at_ease();
  const Vector3d up = look.middle(Landmark::kLeftShoulder) - look.middle(Landmark::kLeftHip);
  if (!(up.norm() > 1e-3)) return state;
  const Vector3d across_hips = look.at(Landmark::kLeftHip) - look.at(Landmark::kRightHip);
  const Vector3d across_shoulders =
      look.at(Landmark::kLeftShoulder) - look.at(Landmark::kRightShoulder);
  state.R_WH = frame_of(across_hips, up);
  const Quaterniond R_WChest = frame_of(across_shoulders, up);
  state.spine = vector_of(state.R_WH.conjugate() * R_WChest);
  if (state.spine.norm() > 1.5) state.spine *= 1.5 / state.spine.norm();
  if (look.sees(Landmark::kLeftEar) && look.sees(Landmark::kRightEar) &&
      look.sees(Landmark::kNose)) {
    const Vector3d ears = look.at(Landmark::kLeftEar) - look.at(Landmark::kRightEar);
    const Vector3d forward = look.at(Landmark::kNose) - look.middle(Landmark::kLeftEar);
    const Quaterniond R_WHead = frame_of(ears, forward.cross(ears));
    state.head = vector_of(R_WChest.conjugate() * R_WHead);
    if (state.head.norm() > 1.5) state.head *= 1.5 / state.head.norm();
  }
  for (std::size_t s = 0; s < 2; ++s) {
    place_arm(look, s, shape, R_WChest, state.sides[s]);
    place_leg(look, s, state.R_WH, state.sides[s]);
  }
  return state;
}

void take_far_limbs(const Observation& seen, const Matrix3d& R_WC, const BodyModel& placed,
                    const BodyState& direct, BodyState& state) {
  const Directions look{seen, R_WC};
  const auto is_far = [&](Landmark from, Landmark to) {
    if (!look.sees(from) || !look.sees(to)) return false;
    const Vector3d is = look.at(to) - look.at(from), was = placed.point(to) - placed.point(from);
    return is.dot(was) < kFarLimb * is.norm() * was.norm();
  };
  for (std::size_t s = 0; s < 2; ++s) {
    const auto far_limb = [&](Landmark upper, Landmark middle, Landmark end) {
      return is_far(of_side(upper, s), of_side(middle, s)) ||
             is_far(of_side(middle, s), of_side(end, s));
    };
    BodyState::Side& to = state.sides[s];
    const BodyState::Side& from = direct.sides[s];
    if (far_limb(Landmark::kLeftShoulder, Landmark::kLeftElbow, Landmark::kLeftWrist)) {
      to.upper_arm = from.upper_arm;
      to.elbow = from.elbow;
      to.turn = from.turn;
    }
    if (far_limb(Landmark::kLeftHip, Landmark::kLeftKnee, Landmark::kLeftAnkle)) {
      to.upper_leg = from.upper_leg;
      to.knee = from.knee;
      to.foot = from.foot;
    }
  }
}

}  // namespace dance

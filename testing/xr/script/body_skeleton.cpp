#include "testing/xr/script/body_skeleton.h"

#include <cmath>

#include "producers/xr/openxr_more.h"
#include "testing/xr/script/hand_skeleton.h"

namespace dance::test_xr {
namespace {

// Who stands at the origin with the head at 1.65 m, looks along -Z, the arms by the sides.
struct Body {
  const XrScript& script;
  double time_s;
  Pose root;  // on the floor under the head, turned as the head is
  double scale;

  Pose at(double x_m, double y_m, double z_m) const {
    return root * pose_of(Eigen::Vector3d(x_m, y_m, z_m) * scale, Eigen::Quaterniond::Identity());
  }
  Pose at(TrackedPoint point, double x_m, double y_m, double z_m) const {
    const PointState state = point_at(script, point, time_s);
    return state.tracking == Tracking::kLost ? at(x_m, y_m, z_m) : pose_of(state);
  }
};

Body body_of(const XrScript& script, double time_s) {
  const PointState head = point_at(script, TrackedPoint::kHead, time_s);
  const Eigen::Vector3d back = head.R * Eigen::Vector3d::UnitZ();
  const double yaw_rad = std::atan2(back.x(), back.z());
  Body body{script, time_s, Pose::Identity(), head.p_m.y() / 1.65};
  body.root.translate(Eigen::Vector3d(head.p_m.x(), 0.0, head.p_m.z()));
  body.root.rotate(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()));
  return body;
}

struct Leg {
  Pose hip, knee, ankle, ball;
};
Leg leg_of(const Body& body, Hand side) {
  const bool is_left = side == Hand::kLeft;
  const double x = is_left ? -0.1 : 0.1;
  Leg leg;
  leg.hip = body.at(x, 0.9, 0.0);
  leg.knee = body.at(is_left ? TrackedPoint::kLeftKnee : TrackedPoint::kRightKnee, x, 0.48, 0.0);
  leg.ankle = body.at(is_left ? TrackedPoint::kLeftFoot : TrackedPoint::kRightFoot, x, 0.08, 0.03);
  leg.ball = leg.ankle * Eigen::Translation3d(0.0, -0.06, -0.15);
  return leg;
}

struct Arm {
  Pose collar, shoulder, elbow, wrist, palm;
};
Arm arm_of(const Body& body, Hand side) {
  const bool is_left = side == Hand::kLeft;
  const double s = is_left ? -1.0 : 1.0;
  Arm arm;
  arm.collar = body.at(s * 0.05, 1.42, 0.02);
  arm.shoulder = body.at(s * 0.18, 1.42, 0.02);
  arm.elbow =
      body.at(is_left ? TrackedPoint::kLeftElbow : TrackedPoint::kRightElbow, s * 0.22, 1.1, 0.02);
  const Pose grip =
      body.at(is_left ? TrackedPoint::kLeftHand : TrackedPoint::kRightHand, s * 0.25, 0.75, -0.05);
  const HandSkeleton hand = hand_skeleton(side, is_fist_at(body.script, body.time_s));
  arm.palm = grip * hand.T_GJ[0];
  arm.wrist = grip * hand.T_GJ[1];
  return arm;
}

void add_arm(const Body& body, Hand side, std::vector<Pose>& joints) {
  const Arm arm = arm_of(body, side);
  joints.insert(joints.end(), {arm.collar, arm.collar, arm.shoulder, arm.elbow, arm.wrist});
}

void add_hand(const Body& body, Hand side, std::vector<Pose>& joints) {
  const bool is_left = side == Hand::kLeft;
  const Pose grip = body.at(is_left ? TrackedPoint::kLeftHand : TrackedPoint::kRightHand,
                            is_left ? -0.25 : 0.25, 0.75, -0.05);
  for (const Pose& joint : hand_skeleton(side, is_fist_at(body.script, body.time_s)).T_GJ)
    joints.push_back(grip * joint);
}

void add_leg(const Body& body, Hand side, std::vector<Pose>& joints) {
  const Leg leg = leg_of(body, side);
  joints.insert(joints.end(),
                {leg.hip, leg.knee, leg.ankle, leg.ankle, leg.ankle, leg.ankle, leg.ball});
}

}  // namespace

std::vector<Pose> full_body(const XrScript& script, double time_s) {
  const Body body = body_of(script, time_s);
  std::vector<Pose> joints{body.root,
                           body.at(TrackedPoint::kHips, 0.0, 0.95, 0.0),
                           body.at(0.0, 1.05, 0.0),
                           body.at(0.0, 1.15, 0.0),
                           body.at(0.0, 1.25, 0.0),
                           body.at(TrackedPoint::kChest, 0.0, 1.35, 0.0),
                           body.at(0.0, 1.48, 0.02),
                           body.at(TrackedPoint::kHead, 0.0, 1.65, 0.0)};
  add_arm(body, Hand::kLeft, joints);
  add_arm(body, Hand::kRight, joints);
  add_hand(body, Hand::kLeft, joints);
  add_hand(body, Hand::kRight, joints);
  add_leg(body, Hand::kLeft, joints);
  add_leg(body, Hand::kRight, joints);
  return joints;
}

std::vector<Pose> small_body(const XrScript& script, double time_s) {
  const Body body = body_of(script, time_s);
  const std::array<Leg, 2> legs{leg_of(body, Hand::kLeft), leg_of(body, Hand::kRight)};
  const std::array<Arm, 2> arms{arm_of(body, Hand::kLeft), arm_of(body, Hand::kRight)};
  return {body.at(TrackedPoint::kHips, 0.0, 0.95, 0.0),
          legs[0].hip,
          legs[1].hip,
          body.at(0.0, 1.07, 0.0),
          legs[0].knee,
          legs[1].knee,
          body.at(0.0, 1.2, 0.0),
          legs[0].ankle,
          legs[1].ankle,
          body.at(TrackedPoint::kChest, 0.0, 1.35, 0.0),
          legs[0].ball,
          legs[1].ball,
          body.at(0.0, 1.48, 0.02),
          arms[0].collar,
          arms[1].collar,
          body.at(TrackedPoint::kHead, 0.0, 1.65, 0.0),
          arms[0].shoulder,
          arms[1].shoulder,
          arms[0].elbow,
          arms[1].elbow,
          arms[0].wrist,
          arms[1].wrist,
          arms[0].palm,
          arms[1].palm};
}

}  // namespace dance::test_xr

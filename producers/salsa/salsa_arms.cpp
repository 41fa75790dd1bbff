#include "producers/salsa/salsa_arms.h"

#include <cmath>

#include "producers/salsa/salsa_ease.h"

namespace dance {
namespace {

using Eigen::AngleAxisf;
using Eigen::Quaternionf;
using Eigen::Vector3f;

struct Arm {
  Limb limb;
  Bone shoulder;
  Tip tip;
  float side;  // +1 left, −1 right
};
constexpr Arm kLeft{kLeftArm, Bone::kLeftShoulder, Tip::kLeftHand, 1.0f};
constexpr Arm kRight{kRightArm, Bone::kRightShoulder, Tip::kRightHand, -1.0f};

float arm_length_m(const Skeleton& skeleton) {
  return skeleton.offset(Bone::kLeftLowerArm).norm() + skeleton.offset(Bone::kLeftHand).norm();
}
float palm_m(const Skeleton& skeleton) { return kPalmShare * skeleton.tip(Tip::kLeftHand).norm(); }
// How far a palm may be from its shoulder with the elbow a little bent and the wrist as well.
float palm_reach_m(const Skeleton& skeleton) {
  return 0.955f * arm_length_m(skeleton) + 0.85f * palm_m(skeleton);
}

// The point, drawn towards the shoulder softly where the arm would have to be stretched.
Vector3f within_reach(const Vector3f& shoulder_m, const Vector3f& point_m, float reach_m) {
  const Vector3f away = point_m - shoulder_m;
  const float r = away.norm();
  const float free_m = 0.86f * reach_m;
  if (r <= free_m) return point_m;
  const float soft_m = reach_m - free_m;
  return shoulder_m + away * ((free_m + soft_m * std::tanh((r - free_m) / soft_m)) / r);
}

const Vector3f& shoulder_of(const SalsaBody& body, const Arm& arm) {
  return body.frames.position(arm.limb.upper);
}
const Quaternionf& chest_of(const SalsaBody& body) {
  return body.frames.R_WB[index_of(Bone::kUpperChest)];
}

Vector3f horizontal(const Vector3f& v) { return {v.x(), 0.0f, v.z()}; }

// A grip that both arms reach: each in turn draws it within its own reach until they agree.
Vector3f agreed_grip(Vector3f grip_m, const Vector3f& lead_shoulder_m, float lead_reach_m,
                     const Vector3f& follow_shoulder_m, float follow_reach_m) {
  for (int i = 0; i < 6; ++i) {
    grip_m = within_reach(lead_shoulder_m, grip_m, lead_reach_m);
    grip_m = within_reach(follow_shoulder_m, grip_m, follow_reach_m);
  }
  return grip_m;
}

struct Blend {  // sum of goals by share
  HandGoal goal{Vector3f::Zero(), Vector3f::Zero(), Vector3f::Zero(), Vector3f::Zero()};
  void add(double share, const HandGoal& other) {
    const auto s = static_cast<float>(share);
    goal.p_WPalm_m += s * other.p_WPalm_m;
    goal.fingers_W += s * other.fingers_W;
    goal.back_W += s * other.back_W;
    goal.elbow_W += s * other.elbow_W;
  }
};

// Directions of a goal in the dancer's own chest, for a hand of the given side: x is outwards.
HandGoal own_goal(const SalsaBody& body, float side, const Vector3f& point_W_m,
                  const Vector3f& fingers, const Vector3f& back, const Vector3f& elbow) {
  const Quaternionf& R_WC = chest_of(body);
  const auto to_W = [&](Vector3f v) {
    v.x() *= side;
    return Vector3f(R_WC * v);
  };
  return {point_W_m, to_W(fingers), to_W(back), to_W(elbow)};
}

struct Couple {
  const Skeleton& lead_skeleton;
  const SalsaBody& lead;
  const Skeleton& follow_skeleton;
  const SalsaBody& follow;
};

// The hands that are always joined: his left, her right.
void led_hands(const Couple& c, CoupleGoals& goals) {
  const SalsaHold& hold = c.lead.hold;
  const Vector3f& his = shoulder_of(c.lead, kLeft);
  const Vector3f& hers = shoulder_of(c.follow, kRight);
  const Vector3f middle = 0.5f * (his + hers);
  const Vector3f to_her = horizontal(c.follow.pose.p_WH_m - c.lead.pose.p_WH_m).normalized();
  const Vector3f out = Vector3f::UnitY().cross(to_her);  // to his left
  const Vector3f top = c.follow.frames.tip(Tip::kHead);

  // In front of both: where they face each other the two shares cancel out, and while she turns
  // towards him his hand leads hers around her.
  const Vector3f ahead =
      chest_of(c.lead) * Vector3f::UnitZ() + chest_of(c.follow) * Vector3f::UnitZ();
  const Vector3f low =
      middle + Vector3f(0.0f, -0.25f, 0.0f) + 0.05f * out + 0.16f * horizontal(ahead);
  const Vector3f side = middle + Vector3f(0.0f, 0.0f, 0.0f) + 0.27f * out;
  const Vector3f over = top + Vector3f(0.0f, 0.10f, 0.0f) - 0.10f * to_her;
  Vector3f grip = static_cast<float>(hold.low) * low + static_cast<float>(hold.side) * side +
                  static_cast<float>(hold.over) * over;
  grip =
      agreed_grip(grip, his, palm_reach_m(c.lead_skeleton), hers, palm_reach_m(c.follow_skeleton));

  Blend lead;
  lead.add(hold.low,
           own_goal(c.lead, 1, grip, {-0.25f, 0.1f, 1}, {0.6f, -0.8f, 0}, {0.7f, -0.7f, -0.4f}));
  lead.add(hold.side, own_goal(c.lead, 1, grip, {0.35f, 0.9f, 0.35f}, {0.5f, 0.2f, -0.8f},
                               {0.6f, -0.9f, -0.2f}));
  lead.add(hold.over, own_goal(c.lead, 1, grip, {-0.1f, 0.9f, 0.5f}, {0.4f, 0.3f, -0.9f},
                               {0.9f, -0.2f, 0.2f}));
  goals.lead.left = lead.goal;
  Blend follow;
  follow.add(hold.low,
             own_goal(c.follow, -1, grip, {-0.25f, 0, 1}, {0.6f, 0.8f, 0}, {0.7f, -0.7f, -0.4f}));
  follow.add(hold.side, own_goal(c.follow, -1, grip, {0.45f, 0.8f, 0.35f}, {0.5f, 0.3f, -0.8f},
                                 {0.6f, -0.9f, -0.2f}));
  follow.add(hold.over, own_goal(c.follow, -1, grip, {-0.2f, 1, 0.1f}, {0.6f, 0.2f, -0.7f},
                                 {0.95f, 0, 0.35f}));
  goals.follow.right = follow.goal;
}

// The hands that hold, embrace or style: his right, her left.
void other_hands(const Couple& c, double beats, CoupleGoals& goals) {
  const SalsaHold& hold = c.lead.hold;
  const Vector3f& his = shoulder_of(c.lead, kRight);
  const Vector3f& hers = shoulder_of(c.follow, kLeft);
  const float his_reach = palm_reach_m(c.lead_skeleton);
  const float her_reach = palm_reach_m(c.follow_skeleton);
  const Vector3f to_her = horizontal(c.follow.pose.p_WH_m - c.lead.pose.p_WH_m).normalized();
  const Vector3f in = Vector3f::UnitY().cross(to_her);
  const Vector3f joined =
      agreed_grip(0.5f * (his + hers) + Vector3f(0.0f, -0.25f, 0.0f) - 0.05f * in, his, his_reach,
                  hers, her_reach);
  const auto in_chest = [](const SalsaBody& body, float x, float y, float z) {
    return Vector3f(body.frames.position(Bone::kUpperChest) + chest_of(body) * Vector3f(x, y, z));
  };
  // Under her arm to the shoulder blade; her hand lies on the outside of his shoulder.
  const Vector3f blade =
      within_reach(his, in_chest(c.follow, 0.165f, -0.02f, -0.045f), his_reach + 0.03f);
  const Vector3f deltoid = within_reach(hers, in_chest(c.lead, -0.215f, 0.10f, 0.055f), her_reach);

  // Free hands move a little with the music: a slow circle, one way over four beats.
  const double round = 0.5 * salsa::kPi * beats;
  const auto wave = static_cast<float>(0.03 * std::sin(round));
  const auto roll = static_cast<float>(0.03 * std::cos(round));
  const auto out = static_cast<float>(hold.flourish);
  const Vector3f his_free = in_chest(c.lead, -0.26f - 0.06f * out, -0.24f + wave, 0.22f + roll);
  const Vector3f her_free = in_chest(c.follow, 0.13f + 0.33f * out, -0.16f + 0.06f * out + wave,
                                     0.24f - 0.06f * out + roll);

  Blend lead;
  lead.add(hold.joined,
           own_goal(c.lead, -1, joined, {-0.25f, 0.1f, 1}, {0.6f, -0.8f, 0}, {0.7f, -0.7f, -0.4f}));
  lead.add(hold.embrace,
           own_goal(c.lead, -1, blade, {-0.35f, 0, 1}, {0.9f, 0.2f, 0.3f}, {0.8f, -0.6f, -0.2f}));
  lead.add(hold.free, own_goal(c.lead, -1, his_free, {-0.5f, 0.2f, 0.9f}, {0.8f, 0.4f, 0.3f},
                               {0.7f, -0.7f, -0.6f}));
  goals.lead.right = lead.goal;
  Blend follow;
  follow.add(hold.joined,
             own_goal(c.follow, 1, joined, {-0.25f, 0, 1}, {0.6f, 0.8f, 0}, {0.7f, -0.7f, -0.4f}));
  follow.add(hold.embrace, own_goal(c.follow, 1, deltoid, {-0.45f, 0.25f, 0.9f},
                                    {0.4f, 0.9f, -0.2f}, {0.95f, -0.35f, -0.2f}));
  follow.add(hold.free, own_goal(c.follow, 1, her_free, {-0.7f + 1.2f * out, 0.25f, 0.6f},
                                 {0.35f, 0.8f, 0.3f}, {0.75f, -0.55f, -0.6f}));
  goals.follow.left = follow.goal;
}

// The part of q that turns about the x axis, halved.
Quaternionf half_twist_about_x(const Quaternionf& q) {
  const double twist = 2.0 * std::atan2(static_cast<double>(q.x()), static_cast<double>(q.w()));
  const double half = 0.5 * salsa::wrapped_angle(twist);
  return Quaternionf(AngleAxisf(static_cast<float>(half), Vector3f::UnitX()));
}

void pose_arm(const Skeleton& skeleton, const Arm& arm, const HandGoal& goal, SalsaBody& body) {
  BodyFrames& frames = body.frames;
  Pose& pose = body.pose;
  const std::size_t chest = index_of(Bone::kUpperChest);
  const std::size_t clavicle = index_of(arm.shoulder);

  // The shoulder blade follows the arm by a part of its way from hanging down.
  const Vector3f to_palm =
      frames.R_WB[chest].conjugate() * (goal.p_WPalm_m - frames.p_WB_m[clavicle]);
  const Vector3f aim = to_palm.normalized();
  const float up = 0.30f * std::max(0.0f, aim.y() + 0.55f) * std::max(0.0f, aim.y() + 0.55f);
  const float ahead = 0.16f * aim.z();
  pose.R_PB[clavicle] = Quaternionf(AngleAxisf(arm.side * -ahead, Vector3f::UnitY())) *
                        Quaternionf(AngleAxisf(arm.side * (up - 0.04f), Vector3f::UnitZ()));
  frames.R_WB[clavicle] = frames.R_WB[chest] * pose.R_PB[clavicle];
  const std::size_t upper = index_of(arm.limb.upper);
  frames.p_WB_m[upper] = frames.p_WB_m[clavicle] + frames.R_WB[clavicle] * skeleton.offset_m[upper];

  // Fingers go on where the arm points, bent towards their hint.
  const Vector3f fingers =
      (0.8f * (goal.p_WPalm_m - frames.p_WB_m[upper]).normalized() + goal.fingers_W.normalized())
          .normalized();
  Eigen::Matrix3f hand;  // columns: where x, y, z of the hand are in W
  hand.col(0) = arm.side * fingers;
  hand.col(1) = (goal.back_W - fingers * fingers.dot(goal.back_W)).normalized();
  hand.col(2) = hand.col(0).cross(hand.col(1));
  const Vector3f wrist = goal.p_WPalm_m - palm_m(skeleton) * fingers;
  solve_two_bone(skeleton, arm.limb, wrist, goal.elbow_W, Quaternionf(hand), pose, frames);

  // The forearm takes half of the hand's turning about it, as it does in a body.
  const std::size_t lower = index_of(arm.limb.lower);
  const std::size_t end = index_of(arm.limb.end);
  const Quaternionf twist = half_twist_about_x(pose.R_PB[end]);
  pose.R_PB[lower] = (pose.R_PB[lower] * twist).normalized();
  pose.R_PB[end] = (twist.conjugate() * pose.R_PB[end]).normalized();
}

}  // namespace

CoupleGoals couple_goals(const Skeleton& lead_skeleton, const SalsaBody& lead,
                         const Skeleton& follow_skeleton, const SalsaBody& follow, double beats) {
  const Couple couple{lead_skeleton, lead, follow_skeleton, follow};
  CoupleGoals goals;
  led_hands(couple, goals);
  other_hands(couple, beats, goals);
  return goals;
}

void pose_arms(const Skeleton& skeleton, const ArmGoals& goals, SalsaBody& body) {
  pose_arm(skeleton, kLeft, goals.left, body);
  pose_arm(skeleton, kRight, goals.right, body);
}

void pose_head(const Skeleton& skeleton, const Vector3f& partner_W_m, SalsaBody& body) {
  const Quaternionf& R_WC = chest_of(body);
  const Vector3f gaze = R_WC.conjugate() * (partner_W_m - body.frames.position(Bone::kHead));
  // sin: straight at the partner while she is in front, as far as a neck turns beside, and ahead
  // again while she is behind, so that a turning head leaves the partner and returns (spotting).
  const double beside = std::atan2(static_cast<double>(gaze.x()), static_cast<double>(gaze.z()));
  const double yaw = 1.05 * std::sin(beside);
  const double flat = std::hypot(static_cast<double>(gaze.x()), static_cast<double>(gaze.z()));
  const double pitch =
      -0.7 * std::atan2(static_cast<double>(gaze.y()), flat + 0.2) * std::cos(0.5 * beside);
  const Vector3f up = R_WC.conjugate() * Vector3f::UnitY();
  const double roll = -0.8 * std::atan2(static_cast<double>(up.x()), static_cast<double>(up.y()));
  const Quaternionf look = Quaternionf(AngleAxisf(static_cast<float>(roll), Vector3f::UnitZ())) *
                           Quaternionf(AngleAxisf(static_cast<float>(yaw), Vector3f::UnitY())) *
                           Quaternionf(AngleAxisf(static_cast<float>(pitch), Vector3f::UnitX()));
  const Quaternionf neck = Quaternionf::Identity().slerp(0.4f, look);
  body.pose.R_PB[index_of(Bone::kNeck)] = neck;
  body.pose.R_PB[index_of(Bone::kHead)] = (neck.conjugate() * look).normalized();
  forward_kinematics(skeleton, body.pose, body.frames);
}

void pose_fingers(const SalsaHold& hold, bool is_lead, double beats, Hands& hands) {
  constexpr std::array<double, 3> kRelaxed_rad{0.34, 0.45, 0.26};
  constexpr std::size_t kBonesPerHand = kFingerBoneCount / 2;
  for (std::size_t i = 0; i < kFingerBoneCount; ++i) {
    const bool is_left = i < kBonesPerHand;
    const std::size_t own = i % kBonesPerHand;
    const std::size_t finger = own / 3;  // 0 thumb … 4 little
    const bool is_led = is_left == is_lead;
    const double grip = is_led ? 1.0 : hold.joined;
    const double breath =
        0.05 * std::sin(0.25 * salsa::kPi * beats + 0.9 * static_cast<double>(finger));
    double curl =
        kRelaxed_rad[own % 3] * (1.0 + 0.7 * grip + 0.10 * static_cast<double>(finger)) + breath;
    // Palms look down in T-pose: fingers curl about the axis along the stage's depth, thumbs about
    // the vertical.
    Vector3f axis = Vector3f::UnitZ();
    if (finger == 0) {
      axis = Vector3f::UnitY();
      curl *= 0.45;
    }
    const double sign = (finger == 0) == is_left ? 1.0 : -1.0;
    hands.R_PB[i] = Quaternionf(AngleAxisf(static_cast<float>(sign * curl), axis));
  }
  hands.presence = (1u << kFingerBoneCount) - 1;
}

}  // namespace dance

#include "producers/camera/hands/palm_wrist.h"

#include <algorithm>
#include <cmath>

#include "core/motion/joint_limits.h"
#include "producers/camera/region/half_turn.h"

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

// The two networks are never so far apart of one hand.
constexpr float kMostApart_rad = radians(75.0f);
constexpr float kMostTwist_rad = radians(80.0f);
constexpr double kSettles_s = 0.5;
constexpr float kLeastTrust = 0.6f;
constexpr Duration kPalmKept = Duration::ms(450);
constexpr Duration kPalmFades = Duration::ms(400);

float twist_about_x(const Quaternionf& q) {
  const float angle = 2.0f * std::atan2(q.x(), q.w());
  return angle > kHalfTurn_rad    ? angle - 2.0f * kHalfTurn_rad
         : angle < -kHalfTurn_rad ? angle + 2.0f * kHalfTurn_rad
                                  : angle;
}
Quaternionf about_x(float angle) {
  return Quaternionf(Eigen::AngleAxisf(angle, Vector3f::UnitX()));
}

}  // namespace

Quaternionf rotation_in_W(const Pose& pose, Bone bone) {
  Quaternionf R = pose.R_PB[index_of(bone)];
  for (int b = kBones[index_of(bone)].parent; b >= 0;
       b = kBones[static_cast<std::size_t>(b)].parent)
    R = pose.R_PB[static_cast<std::size_t>(b)] * R;
  return R.normalized();
}

void PalmWrist::see(HandSide which, const Quaternionf& R_WPalm, const Quaternionf& R_WHand,
                    float trust, MonoTime now) {
  Side& side = sides_[static_cast<std::size_t>(which)];
  const Quaternionf turn = (R_WHand.conjugate() * R_WPalm).normalized();
  if (!(trust > kLeastTrust) || !turn.coeffs().allFinite() ||
      !(turn.angularDistance(Quaternionf::Identity()) < kMostApart_rad))
    return;
  const double passed_s = side.seen ? (now - *side.seen).as_seconds() : 0.0;
  // From nothing, too, it comes in by and by.
  const bool is_new = !side.seen || now - *side.seen > kPalmKept + kPalmFades;
  if (is_new) side.turn.setIdentity();
  const double weight =
      1.0 - std::exp(-(is_new ? 1.0 / 30.0 : std::max(0.0, passed_s)) / kSettles_s);
  side.turn = side.turn.slerp(static_cast<float>(weight), turn).normalized();
  side.seen = now;
}

void PalmWrist::apply(MonoTime now, Pose& pose) const {
  bool is_any = false;
  for (const HandSide which : {HandSide::kLeft, HandSide::kRight}) {
    const Side& side = sides_[static_cast<std::size_t>(which)];
    if (!side.seen) continue;
    const double past = (now - *side.seen - kPalmKept).as_seconds() / kPalmFades.as_seconds();
    const auto share = static_cast<float>(1.0 - std::clamp(past, 0.0, 1.0));
    if (share <= 0.0f) continue;
    is_any = true;
    const bool is_left = which == HandSide::kLeft;
    Quaternionf& R_hand = pose.R_PB[index_of(is_left ? Bone::kLeftHand : Bone::kRightHand)];
    Quaternionf& R_fore = pose.R_PB[index_of(is_left ? Bone::kLeftLowerArm : Bone::kRightLowerArm)];
    const Quaternionf turned =
        (R_hand * Quaternionf::Identity().slerp(share, side.turn)).normalized();
    // The twist of hand and forearm together stays within what a forearm turns.
    const float was = twist_about_x(R_hand), is = twist_about_x(turned);
    const float fore = twist_about_x(R_fore);
    const float whole = std::clamp(fore + is, -std::max(kMostTwist_rad, std::abs(fore + was)),
                                   std::max(kMostTwist_rad, std::abs(fore + was)));
    const float more = whole - fore - was;
    R_fore = (R_fore * about_x(0.5f * more)).normalized();
    R_hand = (about_x(-0.5f * more + whole - fore - is) * turned).normalized();
  }
  if (is_any) limit_joints(pose);
}

}  // namespace dance

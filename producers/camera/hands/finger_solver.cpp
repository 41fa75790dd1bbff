#include "producers/camera/hands/finger_solver.h"

#include <algorithm>
#include <cmath>

#include "core/base/smooth_step.h"
#include "core/pose/mirror.h"
#include "producers/camera/region/half_turn.h"

namespace dance {

using Eigen::AngleAxisf;
using Eigen::Matrix3f;
using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

// From the hand outwards; the least is a straight finger.
constexpr std::array<float, 3> kMostBend{radians(95.0f), radians(110.0f), radians(80.0f)};
constexpr float kMostSpread = radians(25.0f);
// A bent finger cannot be spread: the ligaments beside its first joint are tight.
constexpr float kSpreadEnds = radians(90.0f);
// Of the thumb: its first joint across the palm and out of its plane, then two hinges.
constexpr float kThumbIn = radians(45.0f), kThumbOut = radians(25.0f), kThumbUp = radians(20.0f),
                kThumbDown = radians(50.0f);
constexpr std::array<float, 2> kThumbBend{radians(60.0f), radians(85.0f)};
constexpr float kLeastPalm_m = 0.005f;

// Radians vary with 5° of noise while a hand is still and by 600° a second as it closes.
constexpr OneEuroSetting kAngles{1.5, 0.25, 1.0};
constexpr float kLeastTrusted = 0.15f;
constexpr double kFirst_hz = 30.0;

// Longer than a slow machine takes until it looks again.
constexpr Duration kKept = Duration::ms(500);
constexpr Duration kRelaxed = Duration::ms(1000);

const Vector3f kY = Vector3f::UnitY(), kZ = Vector3f::UnitZ();
// Of a left hand's thumb: half way between its fingers and what is before it; square to that in the
// palm's plane; and where its tip goes as it bends: to the fingers and, less so, into the palm.
const Vector3f kThumbRest(0.70710678f, 0.0f, 0.70710678f);
const Vector3f kThumbAside(0.70710678f, 0.0f, -0.70710678f);
const Vector3f kThumbInside(0.56568542f, -0.6f, -0.56568542f);

Quaternionf about(const Vector3f& axis, float angle) {
  return Quaternionf(AngleAxisf(angle, axis));
}

// Of a left hand: fingers along x, the back of the hand up, thumb towards z. A right one is its
// image in the mirror x = 0.
Vector3f in_left_hand(const Vector3f& in_hand, HandSide side) {
  return side == HandSide::kLeft ? in_hand : mirrored(in_hand);
}
Quaternionf of_side(const Quaternionf& left, HandSide side) {
  return side == HandSide::kLeft ? left : mirrored(left);
}

// How far `v` is bent from x towards the palm, −90° to 270°, so that a fist is no bent-back finger.
float bend_of(const Vector3f& v) {
  const float angle = std::atan2(-v.y(), v.x());
  return angle < -0.5f * kHalfTurn_rad ? angle + 2.0f * kHalfTurn_rad : angle;
}

Quaternionf first_joint(float bend, float spread) { return about(kZ, -bend) * about(kY, -spread); }
Quaternionf hinge(float bend) { return about(kZ, -bend); }
// Towards the fingers about the palm's normal, after out of its plane to where the palm looks.
Quaternionf thumb_joint(float in, float down) { return about(kY, in) * about(kThumbAside, down); }
Quaternionf thumb_hinge(float bend) { return about(kThumbRest.cross(kThumbInside), bend); }

Vector3f direction(const HandLandmarks& hand, std::size_t from, const Quaternionf& R_CHand,
                   HandSide side) {
  const Vector3f bone_m = hand.world_m[from + 1] - hand.world_m[from];
  return in_left_hand(R_CHand.conjugate() * bone_m, side).normalized();
}

void set_thumb(const HandLandmarks& hand, const Quaternionf& R_CHand, HandSide side,
               FingerAngles& angles) {
  const Vector3f v = direction(hand, kHandThumb, R_CHand, side);
  const float in =
      std::clamp(std::atan2(v.x(), v.z()) - 0.25f * kHalfTurn_rad, -kThumbOut, kThumbIn);
  const float down = std::clamp(std::asin(std::clamp(-v.y(), -1.0f, 1.0f)), -kThumbUp, kThumbDown);
  angles.bend[0][0] = in;
  angles.spread[0] = down;
  Quaternionf R = thumb_joint(in, down);
  for (std::size_t joint = 1; joint < 3; ++joint) {
    const Vector3f w = R.conjugate() * direction(hand, kHandThumb + joint, R_CHand, side);
    const float bend = std::atan2(w.dot(kThumbInside), w.dot(kThumbRest));
    angles.bend[0][joint] = std::clamp(bend, 0.0f, kThumbBend[joint - 1]);
    R = R * thumb_hinge(angles.bend[0][joint]);
  }
}

void set_finger(const HandLandmarks& hand, std::size_t finger, const Quaternionf& R_CHand,
                HandSide side, FingerAngles& angles) {
  const std::size_t first = kHandThumb + 4 * finger;
  const Vector3f v = direction(hand, first, R_CHand, side);
  std::array<float, 3>& bend = angles.bend[finger];
  bend[0] = std::clamp(bend_of(v), 0.0f, kMostBend[0]);
  const float most = kMostSpread * std::max(0.0f, 1.0f - bend[0] / kSpreadEnds);
  angles.spread[finger] = std::clamp(std::asin(std::clamp(v.z(), -1.0f, 1.0f)), -most, most);
  Quaternionf R = first_joint(bend[0], angles.spread[finger]);
  for (std::size_t joint = 1; joint < 3; ++joint) {
    const Vector3f w = R.conjugate() * direction(hand, first + joint, R_CHand, side);
    bend[joint] = std::clamp(bend_of(w), 0.0f, kMostBend[joint]);
    R = R * hinge(bend[joint]);
  }
}

FingerAngles scaled(FingerAngles angles, float share) {
  for (auto& finger : angles.bend)
    for (float& bend : finger) bend *= share;
  for (float& spread : angles.spread) spread *= share;
  return angles;
}

}  // namespace

std::optional<Quaternionf> palm_of(const HandLandmarks& hand, HandSide side) {
  const Vector3f along = hand.world_m[kHandMiddle] - hand.world_m[kHandWrist];
  const Vector3f across = hand.world_m[kHandIndex] - hand.world_m[kHandLittle];
  const Vector3f back = across.cross(along);  // of a left hand
  if (!back.allFinite() || !(along.norm() > kLeastPalm_m) ||
      !(back.norm() > kLeastPalm_m * kLeastPalm_m))
    return std::nullopt;
  Matrix3f R;
  const bool is_left = side == HandSide::kLeft;
  R.col(0) = (is_left ? along : Vector3f(-along)).normalized();
  R.col(1) = (is_left ? back : Vector3f(-back)).normalized();
  R.col(2) = R.col(0).cross(R.col(1));
  return Quaternionf(R).normalized();
}

FingerAngles finger_angles(const HandLandmarks& hand, const Quaternionf& R_CHand, HandSide side) {
  FingerAngles angles;
  set_thumb(hand, R_CHand, side, angles);
  for (std::size_t finger = 1; finger < 5; ++finger)
    set_finger(hand, finger, R_CHand, side, angles);
  const auto mend = [](float& angle) {
    if (!std::isfinite(angle)) angle = 0.0f;  // of points in one place
  };
  for (auto& finger : angles.bend) std::for_each(finger.begin(), finger.end(), mend);
  std::for_each(angles.spread.begin(), angles.spread.end(), mend);
  return angles;
}

void write_fingers(const FingerAngles& angles, HandSide side, Hands& out) {
  const std::size_t first = side == HandSide::kLeft ? 0 : kFingerBoneCount / 2;
  for (std::size_t finger = 0; finger < 5; ++finger) {
    const std::array<float, 3>& bend = angles.bend[finger];
    for (std::size_t joint = 0; joint < 3; ++joint) {
      Quaternionf R;
      if (finger == 0)
        R = joint == 0 ? thumb_joint(bend[0], angles.spread[0]) : thumb_hinge(bend[joint]);
      else
        R = joint == 0 ? first_joint(bend[0], angles.spread[finger]) : hinge(bend[joint]);
      out.R_PB[first + 3 * finger + joint] = of_side(R.normalized(), side);
    }
  }
}

void mirror(Hands& hands) {
  constexpr std::size_t kSide = kFingerBoneCount / 2;
  for (std::size_t i = 0; i < kSide; ++i) {
    const Quaternionf left = hands.R_PB[i];
    hands.R_PB[i] = mirrored(hands.R_PB[kSide + i]);
    hands.R_PB[kSide + i] = mirrored(left);
  }
  constexpr std::uint32_t kBits = (1u << kSide) - 1;
  hands.presence = (hands.presence & kBits) << kSide | (hands.presence >> kSide & kBits);
}

void FingerSolver::see(const HandLandmarks& hand, HandSide which, MonoTime now) {
  Side& side = sides_[static_cast<std::size_t>(which)];
  const auto palm = hand.found ? palm_of(hand, which) : std::nullopt;
  side.is_seen = palm.has_value();
  if (!palm) return;
  FingerAngles angles = finger_angles(hand, *palm, which);
  const double passed_s = side.seen ? (now - *side.seen).as_seconds() : 0.0;
  // A hand that comes back is another posture.
  if (!side.seen || now - *side.seen > kKept) side.filters = {};
  const double hz = passed_s > 0.0 ? 1.0 / passed_s : kFirst_hz;
  OneEuroSetting setting = kAngles;
  const auto trust = static_cast<double>(std::max(kLeastTrusted, hand.trust()));
  setting.min_cutoff_hz *= trust / std::max(0.05, smooth_);
  setting.beta *= trust;
  std::size_t at = 0;
  const auto smooth = [&](float& angle) {
    angle = side.filters[at++].next(angle, hz, 1.0, setting);
  };
  for (auto& finger : angles.bend) std::for_each(finger.begin(), finger.end(), smooth);
  std::for_each(angles.spread.begin(), angles.spread.end(), smooth);
  side.angles = angles;
  side.seen = now;
}

float FingerSolver::share_left(const Side& side, MonoTime now) const {
  if (!side.seen) return 0.0f;
  const double past = (now - *side.seen - kKept).as_seconds() / kRelaxed.as_seconds();
  return 1.0f - smooth_step(static_cast<float>(past));
}

bool FingerSolver::write(MonoTime now, Hands& out) const {
  bool is_any = false;
  out.presence = 0;
  for (const HandSide which : {HandSide::kLeft, HandSide::kRight}) {
    const Side& side = sides_[static_cast<std::size_t>(which)];
    const float share = share_left(side, now);
    write_fingers(scaled(side.angles, share), which, out);
    is_any = is_any || share > 0.0f;
    constexpr std::uint32_t kBits = (1u << kFingerBoneCount / 2) - 1;
    // It may not have been looked for since.
    const bool is_seen = side.is_seen && side.seen && now - *side.seen <= kKept;
    if (is_seen) out.presence |= kBits << (which == HandSide::kLeft ? 0 : 15);
  }
  return is_any;
}

}  // namespace dance

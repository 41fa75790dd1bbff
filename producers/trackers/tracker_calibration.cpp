#include "producers/trackers/tracker_calibration.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/pose/heading.h"
#include "core/pose/kinematics.h"
#include "producers/trackers/calibration/standing_body.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

// Body height over eye height (Winter 2009: 1 / 0.936).
constexpr float kHeightOverEyes = 1.72f / 1.61f;
constexpr float kLeastHeight_m = 0.9f, kMostHeight_m = 2.3f;
constexpr float kLeastArm = 0.85f, kMostArm = 1.15f;
constexpr float kMostMount_m = 0.6f;
// A T-pose, in body heights: hands at the shoulders' height, and how far apart.
constexpr float kHandsHeight = 0.79f, kHandsHeightWithin = 0.13f, kLeastSpan = 0.74f;
// Wider than anybody's for the height of the eyes: somebody sits or crouches.
constexpr float kMostSpan = 1.03f;
constexpr float kUpright_cos = 0.87f;
constexpr Duration kRequestHolds = Duration::s(60);
constexpr float kSpanToTheLeft = 0.7f;
// Stretched hands say better than the head where a dancer faces.
constexpr float kTrustHands = 0.7f;
// A headset sits straight on the head within this; a hand holds a controller so.
constexpr float kHeadWithin_rad = 0.45f, kHandWithin_rad = 0.8f;
// How much of a turn in T-pose is the device's, and not the neck's or the wrist's.
constexpr float kTrustHeadTurn = 0.35f, kTrustHandTurn = 0.5f;
// A new height is worth a change of the body.
constexpr float kHeightStep = 0.01f;
constexpr float kFirstPosture_s = 8.0f, kNextPosture_s = 16.0f;

bool is_pair_present(std::uint32_t presence) {
  const auto bit = [&](TrackedPoint p) { return presence >> index_of(p) & 1u; };
  return bit(TrackedPoint::kLeftHand) && bit(TrackedPoint::kRightHand);
}

bool is_nearly(const Mount& a, const Mount& b) {
  return a.is_known == b.is_known && (a.p_BT_m - b.p_BT_m).norm() < 0.005f &&
         a.R_BT.angularDistance(b.R_BT) < 0.02f;
}

float turned_by(float from_rad, float to_rad) {
  return std::remainder(to_rad - from_rad, 2.0f * std::numbers::pi_v<float>);
}

}  // namespace

bool is_valid(const CalibrationValues& values) {
  if (!(values.height_m >= kLeastHeight_m && values.height_m <= kMostHeight_m)) return false;
  if (!(values.arm_ratio >= kLeastArm && values.arm_ratio <= kMostArm)) return false;
  if (values.state > CalibrationState::kFromTPose) return false;
  for (const Mount& mount : values.mounts) {
    if (!mount.is_known) continue;
    if (!mount.p_BT_m.allFinite() || mount.p_BT_m.norm() > kMostMount_m) return false;
    if (!(std::abs(mount.R_BT.norm() - 1.0f) <= 0.01f)) return false;
  }
  return values.mounts[index_of(TrackedPoint::kHead)].is_known;
}

Skeleton skeleton_of(const CalibrationValues& values) {
  Skeleton skeleton = average_skeleton(values.height_m);
  for (const Bone bone :
       {Bone::kLeftLowerArm, Bone::kLeftHand, Bone::kRightLowerArm, Bone::kRightHand})
    skeleton.offset_m[index_of(bone)] *= values.arm_ratio;
  return skeleton;
}

TrackerCalibration::TrackerCalibration() { set_height(values_.height_m); }

void TrackerCalibration::set_height(float height_m) {
  values_.height_m = std::clamp(height_m, kLeastHeight_m, kMostHeight_m);
  for (const TrackedPoint point :
       {TrackedPoint::kHead, TrackedPoint::kLeftHand, TrackedPoint::kRightHand}) {
    Mount& mount = values_.mounts[index_of(point)];
    const Mount nominal = nominal_mount(point, values_.height_m);
    if (!mount.is_known) mount.R_BT = nominal.R_BT;
    mount.p_BT_m = nominal.p_BT_m;
    mount.is_known = true;
  }
}

void TrackerCalibration::reset() { *this = TrackerCalibration(); }

bool TrackerCalibration::restore(const CalibrationValues& values) {
  if (!is_valid(values)) return false;
  reset();
  values_ = values;
  is_height_known_ = true;
  return true;
}

void TrackerCalibration::request_t_pose() {
  is_requested_ = true;
  requested_ = MonoTime();
  hands_seen_ = false;
  still_.clear();
}

float TrackerCalibration::t_pose_progress() const {
  const bool waits = is_requested_ || values_.state != CalibrationState::kFromTPose;
  return waits ? still_.progress() : 0.0f;
}

bool TrackerCalibration::observe(const TrackerFrame& frame) {
  if (!frame.has(TrackedPoint::kHead)) return false;
  follow_request(frame);
  bool changed = take_height(frame);
  const bool is_full = still_.add(frame);
  const bool is_wanted = is_requested_ || values_.state != CalibrationState::kFromTPose;
  if (is_full && is_wanted && is_t_pose(still_)) {
    take_t_pose(still_);
    is_requested_ = false;
    return true;
  }
  if (values_.state == CalibrationState::kFromTPose) return changed;
  usual_.add(frame);
  return take_usual_posture() || changed;
}

// The first guess, so that a dancer who has just come is about as tall as he is.
bool TrackerCalibration::take_height(const TrackerFrame& frame) {
  const float eyes = frame.position(TrackedPoint::kHead).y();
  if (is_height_known_ || eyes * kHeightOverEyes < kLeastHeight_m) return false;
  is_height_known_ = true;
  set_height(eyes * kHeightOverEyes);
  return true;
}

void TrackerCalibration::follow_request(const TrackerFrame& frame) {
  if (!is_requested_) return;
  if (!requested_.is_set()) requested_ = frame.time;
  hands_seen_ =
      hands_seen_ || frame.has(TrackedPoint::kLeftHand) || frame.has(TrackedPoint::kRightHand);
  if (frame.time - requested_ > kRequestHolds) is_requested_ = false;
}

bool TrackerCalibration::is_t_pose(const StillWindow& still) const {
  const BonePlaces& means = still.means();
  const Place& head = means.of(TrackedPoint::kHead);
  const float height = head.p_W_m.y() * kHeightOverEyes;
  if (height < kLeastHeight_m || height > kMostHeight_m) return false;
  const Mount nominal = nominal_mount(TrackedPoint::kHead, height);
  const Quaternionf R_WHead = head.R_W * nominal.R_BT.conjugate();
  if ((R_WHead * Vector3f::UnitY()).y() < kUpright_cos) return false;
  // Of somebody without hands, as far as is known, to stand still is enough.
  if (!is_pair_present(means.presence)) return is_requested_ && !hands_seen_;
  const Vector3f left = means.of(TrackedPoint::kLeftHand).p_W_m;
  const Vector3f right = means.of(TrackedPoint::kRightHand).p_W_m;
  for (const Vector3f& hand : {left, right})
    if (std::abs(hand.y() - kHandsHeight * height) > kHandsHeightWithin * height) return false;
  Vector3f span = left - right;
  span.y() = 0.0f;
  const Vector3f to_left = heading_turn(R_WHead) * Vector3f::UnitX();
  return span.norm() > kLeastSpan * height && span.norm() < kMostSpan * height &&
         to_left.dot(span) > kSpanToTheLeft * span.norm();
}

void TrackerCalibration::take_t_pose(const StillWindow& still) {
  const BonePlaces& means = still.means();
  const Place& head = means.of(TrackedPoint::kHead);
  const bool has_hands = is_pair_present(means.presence);
  set_height(head.p_W_m.y() * kHeightOverEyes);
  is_height_known_ = true;
  const Mount nominal = nominal_mount(TrackedPoint::kHead, values_.height_m);
  float facing_rad = heading_rad(head.R_W * nominal.R_BT.conjugate());
  if (has_hands) {
    const Vector3f span =
        means.of(TrackedPoint::kLeftHand).p_W_m - means.of(TrackedPoint::kRightHand).p_W_m;
    const Vector3f ahead = span.cross(Vector3f::UnitY());
    facing_rad += kTrustHands * turned_by(facing_rad, std::atan2(ahead.x(), ahead.z()));
  }
  const Quaternionf R_WFacing = about_up(facing_rad);
  if (has_hands) take_arms(still, R_WFacing);
  const StandingBody body(skeleton_of(values_), means, R_WFacing, nominal);
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    if ((means.presence >> i & 1u) == 0) continue;
    const auto point = static_cast<TrackedPoint>(i);
    Mount& mount = values_.mounts[i];
    const Mount found = mount_between(body.bone(point), means.places[i]);
    const Mount usual = nominal_mount(point, values_.height_m);
    if (!usual.is_known) {
      mount = found;
      continue;
    }
    const bool is_head = point == TrackedPoint::kHead;
    const float apart = usual.R_BT.angularDistance(found.R_BT);
    mount = usual;
    if (apart < (is_head ? kHeadWithin_rad : kHandWithin_rad))
      mount.R_BT = usual.R_BT.slerp(is_head ? kTrustHeadTurn : kTrustHandTurn, found.R_BT);
  }
  values_.state = CalibrationState::kFromTPose;
}

void TrackerCalibration::take_arms(const StillWindow& still, const Quaternionf& R_WFacing) {
  values_.arm_ratio = 1.0f;
  const Skeleton skeleton = skeleton_of(values_);
  const StandingBody body(skeleton, still.means(), R_WFacing,
                          nominal_mount(TrackedPoint::kHead, values_.height_m));
  float measured = 0.0f;
  for (const TrackedPoint hand : {TrackedPoint::kLeftHand, TrackedPoint::kRightHand})
    measured += (body.wrist(hand) - body.shoulder(hand)).norm();
  const float average = 2.0f * (skeleton.offset(Bone::kLeftLowerArm).norm() +
                                skeleton.offset(Bone::kLeftHand).norm());
  values_.arm_ratio = std::clamp(measured / average, kLeastArm, kMostArm);
}

bool TrackerCalibration::take_usual_posture() {
  const float next = kFirstPosture_s + kNextPosture_s * static_cast<float>(postures_taken_);
  if (usual_.counted_s() < next) return false;
  ++postures_taken_;
  const float height = usual_.eyes_m() * kHeightOverEyes;
  if (height < kLeastHeight_m) return false;
  bool changed = values_.state != CalibrationState::kFromWalking;
  if (std::abs(height - values_.height_m) > kHeightStep * values_.height_m) {
    set_height(height);
    changed = true;
  }
  BonePlaces usual;
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    const auto point = static_cast<TrackedPoint>(i);
    if (usual_.seen_s(point) > UsualPosture::kEnough_s / 4.0f)
      usual.put(point, usual_.usual_place(point));
  }
  const StandingBody body(skeleton_of(values_), usual, Quaternionf::Identity(),
                          nominal_mount(TrackedPoint::kHead, values_.height_m),
                          StandingBody::Arms::kHang);
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    const auto point = static_cast<TrackedPoint>(i);
    const bool is_worn = !nominal_mount(point, values_.height_m).is_known;
    if (!is_worn || !usual.has(point)) continue;
    const Mount found = mount_between(body.bone(point), usual.places[i]);
    // Nobody wears it there.
    if (found.p_BT_m.norm() > kMostMount_m) continue;
    changed = changed || !is_nearly(values_.mounts[i], found);
    values_.mounts[i] = found;
  }
  values_.state = CalibrationState::kFromWalking;
  return changed;
}

void TrackerCalibration::place_bones(const TrackerFrame& frame, BonePlaces& bones) const {
  bones.presence = 0;
  bones.time = frame.time;
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    if ((frame.presence >> i & 1u) == 0 || !values_.mounts[i].is_known) continue;
    bones.put(static_cast<TrackedPoint>(i),
              bone_place(values_.mounts[i], {frame.p_WT_m[i], frame.R_WT[i].normalized()}));
  }
}

}  // namespace dance

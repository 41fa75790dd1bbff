#include "producers/trackers/calibration/usual_posture.h"

#include <algorithm>
#include <cmath>

#include "core/pose/heading.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kLongestPostureStep_s = 0.2f;
constexpr float kFacing_s = 0.4f, kWalk_s = 0.5f;
// Straight walks say where a dancer faces; who dances goes backwards as well.
constexpr float kWalks_m_s = 0.6f;
constexpr float kForward = 0.8f;
constexpr float kFootStands_m_s = 0.12f, kFootOver_s = 0.1f;
// The eyes' usual height: quickly up, slowly down, so that it stays near the upper end.
constexpr float kMoves_m_s = 0.06f, kSpeedOver_s = 1.0f;
constexpr float kRemembers_s = 60.0f;
constexpr float kPutOn = 1.1f, kCrouches = 0.85f;
constexpr float kEyesUp_s = 0.6f, kEyesDown_s = 15.0f;

bool is_foot(std::size_t point) {
  return point == index_of(TrackedPoint::kLeftFoot) || point == index_of(TrackedPoint::kRightFoot);
}

Vector3f head_on_floor(const TrackerFrame& frame) {
  const Vector3f& p = frame.position(TrackedPoint::kHead);
  return {p.x(), 0.0f, p.z()};
}

}  // namespace

void UsualPosture::follow_facing(const TrackerFrame& frame, float seconds) {
  const Mount head = nominal_mount(TrackedPoint::kHead, 1.72f);
  const Quaternionf R_WHead = frame.rotation(TrackedPoint::kHead) * head.R_BT.conjugate();
  Quaternionf facing = heading_turn(R_WHead);
  const Vector3f moved = head_on_floor(frame) - head_on_floor(before_);
  walk_m_s_ += (moved / seconds - walk_m_s_) * (1.0f - std::exp(-seconds / kWalk_s));
  const Vector3f ahead = facing * Vector3f::UnitZ();
  const float speed = walk_m_s_.norm();
  if (speed > kWalks_m_s && ahead.dot(walk_m_s_) > kForward * speed)
    facing = about_up(std::atan2(walk_m_s_.x(), walk_m_s_.z()));
  R_WFacing_ = R_WFacing_.slerp(1.0f - std::exp(-seconds / kFacing_s), facing);
}

// A headset that lies still is on no head.
bool UsualPosture::counts(const TrackerFrame& frame, float seconds) {
  const Vector3f moved =
      frame.position(TrackedPoint::kHead) - before_.position(TrackedPoint::kHead);
  speed_m_s_ += (moved.norm() / seconds - speed_m_s_) * (1.0f - std::exp(-seconds / kSpeedOver_s));
  return speed_m_s_ > kMoves_m_s;
}

void UsualPosture::forget_sums() {
  eyes_of_sums_m_ = eyes_m_;
  position_sums_ = zeros();
  rotation_sums_ = zeros4();
  seen_s_.fill(0.0f);
}

void UsualPosture::add(const TrackerFrame& frame) {
  if (!frame.has(TrackedPoint::kHead)) return;
  const auto seconds = static_cast<float>((frame.time - before_.time).as_seconds());
  const TrackerFrame before = before_;
  if (!began_ || seconds <= 0.0f || seconds > kLongestPostureStep_s) {
    if (began_ && seconds <= 0.0f) return;
    before_ = frame;
    walk_m_s_.setZero();
    follow_facing(frame, 1.0f);
    began_ = true;
    return;
  }
  follow_facing(frame, seconds);
  const bool is_worn = counts(frame, seconds);
  before_ = frame;
  const float eyes = frame.position(TrackedPoint::kHead).y();
  if (eyes_m_ == 0.0f) eyes_m_ = eyes;
  eyes_m_ +=
      (eyes - eyes_m_) * (1.0f - std::exp(-seconds / (eyes > eyes_m_ ? kEyesUp_s : kEyesDown_s)));
  // It was put on: what was seen before is of a table.
  if (eyes_m_ > kPutOn * eyes_of_sums_m_) forget_sums();
  if (!is_worn || eyes < kCrouches * eyes_m_) return;
  counted_s_ += seconds;
  const Vector3f origin = head_on_floor(frame);
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    if ((frame.presence & before.presence) >> i & 1u) {
      // Over a tenth of a second, as noise would make any foot move.
      lately_m_[i] += (frame.p_WT_m[i] - lately_m_[i]) * (1.0f - std::exp(-seconds / kFootOver_s));
      const float speed = (frame.p_WT_m[i] - lately_m_[i]).norm() / kFootOver_s;
      if (is_foot(i) && speed > kFootStands_m_s) continue;
      const Quaternionf R = R_WFacing_.conjugate() * frame.R_WT[i];
      const Eigen::Vector4f c = R.coeffs();
      const float sign = rotation_sums_[i].dot(c) < 0.0f ? -1.0f : 1.0f;
      rotation_sums_[i] += seconds * sign * c;
      position_sums_[i] += seconds * (R_WFacing_.conjugate() * (frame.p_WT_m[i] - origin));
      seen_s_[i] += seconds;
      if (seen_s_[i] > kRemembers_s) {
        const float kept = kRemembers_s / seen_s_[i];
        rotation_sums_[i] *= kept;
        position_sums_[i] *= kept;
        seen_s_[i] = kRemembers_s;
      }
    }
  }
}

Place UsualPosture::usual_place(TrackedPoint point) const {
  const std::size_t i = index_of(point);
  Place place;
  if (seen_s_[i] <= 0.0f || rotation_sums_[i].norm() <= 0.0f) return place;
  place.p_W_m = position_sums_[i] / seen_s_[i];
  place.R_W.coeffs() = rotation_sums_[i].normalized();
  return place;
}

}  // namespace dance

#include "transformers/partner/partner_track.h"

#include <algorithm>

#include "core/motion/palm_pull.h"
#include "core/pose/kinematics.h"

namespace dance {
namespace {

PartnerMoment between(const PartnerMoment& a, const PartnerMoment& b, MonoTime time) {
  const double span = (b.time - a.time).as_seconds();
  const auto t = static_cast<float>((time - a.time).as_seconds() / std::max(span, 1e-6));
  const auto mix = [t](const Eigen::Vector3f& x, const Eigen::Vector3f& y) {
    return Eigen::Vector3f(x + t * (y - x));
  };
  PartnerMoment out;
  out.time = time;
  for (std::size_t side = 0; side < 2; ++side)
    out.p_WPalm_m[side] = mix(a.p_WPalm_m[side], b.p_WPalm_m[side]);
  out.p_WHips_m = mix(a.p_WHips_m, b.p_WHips_m);
  out.facing_W = facing_along(mix(a.facing_W, b.facing_W));
  for (std::size_t side = 0; side < 2; ++side) {
    const Eigen::Vector4f& from = a.R_WHand[side].coeffs();
    const Eigen::Vector4f& to = b.R_WHand[side].coeffs();
    const float same = from.dot(to) < 0.0f ? -1.0f : 1.0f;
    out.R_WHand[side].coeffs() = from + t * (same * to - from);
    out.R_WHand[side].normalize();
  }
  return out;
}

}  // namespace

Eigen::Vector3f facing_along(const Eigen::Vector3f& v) {
  const Eigen::Vector3f along(v.x(), 0.0f, v.z());
  const float size = along.norm();
  return size > 1e-3f ? Eigen::Vector3f(along / size) : Eigen::Vector3f::UnitZ();
}

PartnerTrack::PartnerTrack() : skeleton_(average_skeleton()) {}

void PartnerTrack::set_body(const Skeleton& skeleton) {
  if (is_valid(skeleton)) skeleton_ = skeleton;
}

void PartnerTrack::take(const Pose& pose) {
  if (size_ > 0) {
    const Duration step = pose.capture_time - newest().time;
    if (pose.clock_id == clock_id_ && step <= Duration() && step > -kGap) return;
    if (pose.clock_id != clock_id_ || step <= Duration() || step > kGap) size_ = 0;
  }
  clock_id_ = pose.clock_id;
  BodyFrames frames;
  forward_kinematics(skeleton_, pose, frames);
  PartnerMoment& now = moments_[next_];
  now.time = pose.capture_time;
  for (std::size_t side = 0; side < 2; ++side)
    now.p_WPalm_m[side] = palm_of(skeleton_, frames, side);
  now.p_WHips_m = frames.p_WB_m[0];
  for (std::size_t side = 0; side < 2; ++side)
    now.R_WHand[side] = frames.R_WB[index_of(kHandBones[side])];
  now.facing_W = facing_along(frames.R_WB[0] * Eigen::Vector3f::UnitZ());
  next_ = (next_ + 1) % kKept;
  size_ = std::min(size_ + 1, kKept);
}

std::optional<PartnerMoment> PartnerTrack::at(MonoTime time) const {
  if (size_ < 2 || time > newest().time + kAhead) return std::nullopt;
  std::size_t age = 1;
  if (time > newest().time) {
    while (age + 1 < size_ && newest().time - back(age).time < kSlope) ++age;
    return between(back(age), newest(), time);
  }
  while (age < size_ && back(age).time > time) ++age;
  if (age == size_) return std::nullopt;
  return between(back(age), back(age - 1), time);
}

std::optional<PartnerMoment> PartnerTrack::at_latest(MonoTime time) const {
  return size_ == 0 ? std::nullopt : at(std::min(time, newest().time + kAhead));
}

}  // namespace dance

#include "transformers/stylize.h"

#include <algorithm>
#include <cmath>

#include "transformers/joint_limits.h"
#include "transformers/rotation_vector.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kGainPerSecond = 1.0f;
constexpr Duration kLongestStyleStep = Duration::ms(100);
constexpr double kComeIn_s = 2.0;
// So much faster than the mean pose itself: a new hold is not shown larger while the mean comes to it.
constexpr double kBiasFaster = 3.0;
// Two poses further apart than this are not one movement.
constexpr Duration kAnotherTake = Duration::s(1);
// A foot slower than the one stands, faster than the other it swings; it changes within a tenth of a second.
constexpr float kStands_m_s = 0.15f, kSwings_m_s = 0.6f;
constexpr float kStandingPerSecond = 10.0f;
constexpr float kAnkleFloorRises_m_s = 0.02f;

// What is added to a joint, to the sway, and to where a foot swings, stays below this, whatever the gain: arms that are
// thrown up are not thrown over. Two thirds of it are added as they are, within half a hundredth.
constexpr float kMostAdded_rad = 0.7f;
constexpr float kMostSway_m = 0.2f;
constexpr float kMostSwing_m = 0.15f;

// v / (1 + |v / most|⁸)^(1/8)
Vector3f saturated(const Vector3f& v, float most) {
  const float size2 = v.squaredNorm() / (most * most);
  const float size8 = size2 * size2 * size2 * size2;
  return v / std::sqrt(std::sqrt(std::sqrt(1.0f + size8)));
}

float towards(float from, float to, float most) {
  return from + std::clamp(to - from, -most, most);
}

}  // namespace

Stylize::Stylize(const Style& base) : base_(base), skeleton_(average_skeleton()) {
  aim();
  // What the session says holds from the first pose on.
  gain_ = wanted_gain_;
  periodic_ = wanted_periodic_;
  dynamic_ = wanted_dynamic_;
}

void Stylize::aim() {
  for (std::size_t z = 0; z < kBodyZones; ++z)
    wanted_gain_[z] = std::min(base_.gain[z] * live_.gain[z], kMostStyleGain);
  wanted_periodic_ = std::min(base_.periodic * live_.periodic, kMostStyleGain);
  wanted_dynamic_ = std::min(base_.dynamic * live_.dynamic, kMostStyleGain);
}

void Stylize::set_style(const Style& style) {
  if (!is_valid(style)) {
    ++counters_.refused;
    return;
  }
  live_ = style;
  aim();
}

void Stylize::set_body(const Skeleton& skeleton) {
  skeleton_ = skeleton;
  period_.set_body(skeleton);
}

void Stylize::observe(const Pose& pose, MonoTime now) {
  // Where the dancer's music is known, nobody has to guess the bar.
  if (!std::isfinite(pose.music_beats)) period_.observe(pose, now);
  newest_ = pose;
  has_newest_ = true;
}

void Stylize::advance_gains(MonoTime now) {
  const Duration step = std::clamp(now - sampled_, Duration(), kLongestStyleStep);
  sampled_ = now;
  const float most = kGainPerSecond * static_cast<float>(step.as_seconds());
  for (std::size_t z = 0; z < kBodyZones; ++z) gain_[z] = towards(gain_[z], wanted_gain_[z], most);
  periodic_ = towards(periodic_, wanted_periodic_, most);
  dynamic_ = towards(dynamic_, wanted_dynamic_, most);
}

double Stylize::bars_of(const Pose& pose) const {
  if (std::isfinite(pose.music_beats)) return pose.music_beats / Period::kBeatsPerBar;
  return period_.is_known() ? period_.beats(pose.capture_time) / Period::kBeatsPerBar : kNoMusic;
}

bool Stylize::is_plain() const {
  const bool is_as_danced =
      std::all_of(gain_.begin(), gain_.end(), [](float gain) { return gain == 1.0f; });
  return is_as_danced || (periodic_ == 0.0f && dynamic_ == 0.0f) || come_in_ == 0.0f;
}

bool Stylize::sample(MonoTime now, Pose& out) {
  if (input_ ? !input_->sample(now, out) : !has_newest_) return false;
  if (!input_) out = newest_;
  advance_gains(now);
  BodyFrames frames;
  forward_kinematics(skeleton_, out, frames);
  const double bars = bars_of(out);
  const Duration step = out.capture_time - learnt_;
  const bool begins = !split_.has_begun() || out.clock_id != clock_id_ || step > kAnotherTake ||
                      step < -kAnotherTake;
  if (begins) {
    if (split_.has_begun()) ++counters_.restarts;
    split_.forget();
    come_in_ = 0.0f;
  }
  split_.split(out, frames, bars, parts_);
  if (begins || step > Duration()) follow(out, frames, bars, begins);
  if (!is_plain()) apply(frames, parts_, out);
  return true;
}

bool Stylize::sample_at(MonoTime moment, MonoTime now, Pose& out) {
  if (!input_ || !input_->sample_at(moment, now, out)) return false;
  if (is_plain() || !split_.has_begun()) return true;
  BodyFrames frames;
  forward_kinematics(skeleton_, out, frames);
  MotionSplit::Parts parts;
  split_.split(out, frames, bars_of(out), parts);
  apply(frames, parts, out);
  return true;
}

void Stylize::follow(const Pose& pose, const BodyFrames& frames, double bars, bool begins) {
  // The first pose counts as one of sixty a second.
  const double dt_s = begins ? 1.0 / 60.0 : (pose.capture_time - learnt_).as_seconds();
  if (begins) {
    bias_.turn.fill(Vector3f::Zero());
    bias_.sway_m.setZero();
  }
  follow_bias(parts_, std::min(dt_s, kLongestStyleStep.as_seconds()));
  split_.learn(parts_, bars, std::min(dt_s, kLongestStyleStep.as_seconds()));
  follow_feet(frames, static_cast<float>(dt_s), begins);
  come_in_ = towards(come_in_, 1.0f, static_cast<float>(dt_s / kComeIn_s));
  learnt_ = pose.capture_time;
  clock_id_ = pose.clock_id;
}

void Stylize::follow_feet(const BodyFrames& frames, float dt_s, bool begins) {
  for (std::size_t side = 0; side < 2; ++side) {
    Foot& foot = feet_[side];
    const Vector3f& p_W_m = frames.position(side == 0 ? Bone::kLeftFoot : Bone::kRightFoot);
    if (begins) foot = {p_W_m, 1.0f, p_W_m.y()};
    const float speed = (p_W_m - foot.p_W_m).norm() / dt_s;
    const float wanted =
        std::clamp((kSwings_m_s - speed) / (kSwings_m_s - kStands_m_s), 0.0f, 1.0f);
    foot.standing = towards(foot.standing, wanted, kStandingPerSecond * dt_s);
    foot.floor_m = std::min(p_W_m.y(), foot.floor_m + kAnkleFloorRises_m_s * dt_s);
    foot.p_W_m = p_W_m;
  }
}

Vector3f Stylize::added_turn(std::size_t bone, const MotionSplit::Parts& parts) const {
  const float gain = gain_[index_of(kZoneOfBone[bone])];
  return saturated(
      (gain - 1.0f) * (periodic_ * parts.periodic.turn[bone] + dynamic_ * parts.rest.turn[bone]),
      kMostAdded_rad);
}

Vector3f Stylize::added_sway(const MotionSplit::Parts& parts) const {
  return saturated((gain_[index_of(BodyZone::kHips)] - 1.0f) *
                       (periodic_ * parts.periodic.sway_m + dynamic_ * parts.rest.sway_m),
                   kMostSway_m);
}

// The mean pose is kept by what is added, too: its own mean is taken off. The periodic part has none.
void Stylize::follow_bias(const MotionSplit::Parts& parts, double dt_s) {
  const auto share = static_cast<float>(std::min(1.0, kBiasFaster * split_.mean_share(dt_s)));
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const float more = (gain_[index_of(kZoneOfBone[b])] - 1.0f) * periodic_;
    bias_.turn[b] += share * (added_turn(b, parts) - more * parts.periodic.turn[b] - bias_.turn[b]);
  }
  const float more = (gain_[index_of(BodyZone::kHips)] - 1.0f) * periodic_;
  bias_.sway_m += share * (added_sway(parts) - more * parts.periodic.sway_m - bias_.sway_m);
}

void Stylize::apply(const BodyFrames& before, const MotionSplit::Parts& parts, Pose& pose) const {
  const Pose was = pose;
  const auto gain_of = [&](BodyZone zone) { return gain_[index_of(zone)]; };
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const float gain = gain_of(kZoneOfBone[b]);
    if (gain == 1.0f || (pose.presence >> b & 1u) == 0) continue;
    const Vector3f more = come_in_ * (added_turn(b, parts) - bias_.turn[b]);
    const Quaternionf turned = split_.turned(b, parts.deviation.turn[b] + more);
    pose.R_PB[b] = b == 0 ? (parts.R_heading * turned).normalized() : turned;
  }
  // What made a joint's turn larger may not break the joint; who goes beyond by themselves may.
  Pose limited = pose;
  if (limit_joints(limited) > 0)
    for (std::size_t b = 1; b < kBoneCount; ++b)
      if (gain_of(kZoneOfBone[b]) > 1.0f) pose.R_PB[b] = limited.R_PB[b];
  const float hips = gain_of(BodyZone::kHips);
  if (hips != 1.0f) {
    Vector3f sway = come_in_ * (added_sway(parts) - bias_.sway_m);
    sway.z() = 0.0f;  // forward and back is where the steps go
    pose.p_WH_m += parts.R_heading * sway;
  }
  if (hips != 1.0f || gain_of(BodyZone::kLegs) != 1.0f) stand(was, before, pose);
}

void Stylize::stand(const Pose& was, const BodyFrames& before, Pose& pose) const {
  BodyFrames frames;
  forward_kinematics(skeleton_, pose, frames);
  const bool legs_swing = gain_[index_of(BodyZone::kLegs)] != 1.0f;
  const BodyFrames swung = frames;
  const float drop =
      needed_drop_m(skeleton_, before,
                    {frames.position(Bone::kLeftUpperLeg), frames.position(Bone::kRightUpperLeg)});
  pose.p_WH_m.y() -= drop;
  for (std::size_t side = 0; side < 2; ++side) {
    const Limb& leg = side == 0 ? kLeftLeg : kRightLeg;
    const std::size_t upper = index_of(leg.upper), end = index_of(leg.end);
    frames.p_WB_m[upper].y() -= drop;
    Vector3f target = before.p_WB_m[end];
    Quaternionf R_WFoot = before.R_WB[end];
    if (legs_swing) {
      const float swing = 1.0f - feet_[side].standing;
      const Vector3f hip_moved = swung.p_WB_m[upper] - before.p_WB_m[upper];
      target += swing * saturated(swung.p_WB_m[end] - hip_moved - before.p_WB_m[end], kMostSwing_m);
      target.y() = std::max(target.y(), std::min(before.p_WB_m[end].y(), feet_[side].floor_m));
      R_WFoot = R_WFoot.slerp(swing, swung.R_WB[end]);
      const std::size_t toes = end + 1;
      pose.R_PB[toes] = was.R_PB[toes].slerp(swing, pose.R_PB[toes]);
    }
    reach_ankle(skeleton_, leg, before, target, R_WFoot, pose, frames);
  }
}

}  // namespace dance

#include "transformers/style/stylize.h"

#include <algorithm>
#include <cmath>

#include "core/motion/joint_limits.h"
#include "core/motion/rotation_vector.h"
#include "core/motion/saturated.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kGainPerSecond = 1.0f;
constexpr Duration kLongestStyleStep = Duration::ms(100);
constexpr double kComeIn_s = 2.0;
// So much faster than the mean pose itself: a new hold is not shown larger while the mean comes to
// it.
constexpr double kBiasFaster = 4.0;
// Of what legs are told to do more, straight knees and flat soles let through about so much less.
constexpr float kLegsMore = 1.3f;
// Two poses further apart than this are not one movement.
constexpr Duration kAnotherTake = Duration::s(1);
// What is added to a joint and to the sway stays below this, whatever the gain: arms that are
// thrown up are not thrown over.
constexpr float kMostAdded_rad = 0.7f;
constexpr float kMostSway_m = 0.2f;
// Hips make so much more of the sway at most, where legs have made it larger already.
constexpr float kMostSwayOfLegs = 2.0f;
// A knee is told to bend by this at least, or by as little as it was danced with.
constexpr float kLeastBend_rad = 0.05f;
constexpr std::size_t kFirstLegBone = index_of(Bone::kLeftUpperLeg);
// Thighs, shanks and feet; toes are not everywhere.
constexpr std::uint32_t kLegBones =
    7u << index_of(Bone::kLeftUpperLeg) | 7u << index_of(Bone::kRightUpperLeg);
// Over longer steps hips come down this fast where a leg would not reach.
constexpr float kDropComes_s = 0.03f, kDropFastest_m_s = 2.0f;

float towards(float from, float to, float most) {
  return from + std::clamp(to - from, -most, most);
}

}  // namespace

Stylize::Stylize(const Style& base) : base_(base), skeleton_(average_skeleton()) {
  aim();
  // What the session file says holds from the first pose on.
  gain_ = wanted_gain_;
  periodic_ = wanted_periodic_;
  dynamic_ = wanted_dynamic_;
}

void Stylize::aim() {
  for (std::size_t z = 0; z < kBodyZones; ++z)
    wanted_gain_[z] = is_on_ ? std::min(base_.gain[z] * live_.gain[z], kMostStyleGain) : 1.0f;
  wanted_periodic_ = std::min(base_.periodic * live_.periodic, kMostStyleGain);
  wanted_dynamic_ = std::min(base_.dynamic * live_.dynamic, kMostStyleGain);
}

void Stylize::set(const FlowSetting& setting) {
  Style style;
  style.gain = setting.gain;
  style.periodic = setting.periodic;
  style.dynamic = setting.dynamic;
  if (!is_valid(style)) {
    ++refused_;
    return;
  }
  base_ = style;
  is_on_ = setting.is_on(FlowWord::kStylize);
  aim();
}

void Stylize::set_style(const Style& style) {
  if (!is_valid(style)) {
    ++refused_;
    return;
  }
  live_ = style;
  aim();
}

void Stylize::set_body(const Skeleton& skeleton) {
  // Other legs have their ankles elsewhere over the floor.
  if (skeleton.offset_m != skeleton_.offset_m) feet_begin_ = true;
  skeleton_ = skeleton;
  period_.set_body(skeleton);
}

void Stylize::observe(const Pose& pose, MonoTime now) {
  // Where the dancer's music is known, the bar need not be found in the motion.
  if (!std::isfinite(pose.music_beats)) period_.observe(pose, now);
}

void Stylize::advance_gains(MonoTime now) {
  const Duration step = std::clamp(now - applied_, Duration(), kLongestStyleStep);
  applied_ = now;
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
  return standing_.steps.is_home() && (come_in_ == 0.0f || is_as_danced);
}

bool Stylize::legs_are_scaled() const {
  return gain_[index_of(BodyZone::kLegs)] != 1.0f || !standing_.steps.is_home();
}

void Stylize::apply(MonoTime now, Pose& pose) {
  advance_gains(now);
  BodyFrames frames;
  forward_kinematics(skeleton_, pose, frames);
  const double bars = bars_of(pose);
  const Duration step = pose.capture_time - learnt_;
  const bool begins = !split_.has_begun() || pose.clock_id != clock_id_ || step > kAnotherTake ||
                      step < -kAnotherTake;
  if (begins) {
    if (split_.has_begun()) ++restarts_;
    split_.forget();
    // Over a gap feet stay where they were set down.
    if (pose.clock_id != clock_id_ || step < Duration()) standing_ = {};
    come_in_ = 0.0f;
  }
  split_.split(pose, frames, bars, parts_);
  const double step_s = begins || step > Duration() ? follow(pose, frames, bars, begins) : 0.0;
  if (!is_plain()) show(frames, parts_, static_cast<float>(step_s), pose);
}

double Stylize::follow(const Pose& pose, const BodyFrames& frames, double bars, bool begins) {
  // The first pose counts as one of sixty a second.
  const double dt_s = begins ? 1.0 / 60.0 : (pose.capture_time - learnt_).as_seconds();
  const double step_s = std::min(dt_s, kLongestStyleStep.as_seconds());
  if (begins) {
    bias_.fill({});
    sway_bias_ = {};
  }
  follow_bias(parts_, step_s);
  split_.learn(parts_, bars, step_s);
  feet_.follow(frames, static_cast<float>(dt_s), begins || feet_begin_);
  feet_begin_ = false;
  come_in_ = towards(come_in_, 1.0f, static_cast<float>(dt_s / kComeIn_s));
  learnt_ = pose.capture_time;
  clock_id_ = pose.clock_id;
  return step_s;
}

float Stylize::more_of(BodyZone zone) const {
  const float more = gain_[index_of(zone)] - 1.0f;
  return zone == BodyZone::kLegs ? std::max(-1.0f, kLegsMore * more) : more;
}

Vector3f Stylize::addable_turn(std::size_t bone, const MotionSplit::Parts& parts) const {
  return periodic_ * parts.periodic.turn[bone] + dynamic_ * parts.rest.turn[bone];
}

Vector3f Stylize::addable_sway(const MotionSplit::Parts& parts) const {
  return periodic_ * parts.periodic.sway_m + dynamic_ * parts.rest.sway_m;
}

// The mean pose is kept by what is added, too: its own mean is taken off. What comes again with
// each bar has next to none: there a slow mean takes off what has changed since, and the bar keeps
// its phase. Hips and legs hold their bar, and after a stunt they are not to lean to its other
// side.
void Stylize::follow_bias(const MotionSplit::Parts& parts, double dt_s) {
  const double share = split_.mean_share(dt_s);
  const auto slow = static_cast<float>(std::min(1.0, share));
  const auto fast = static_cast<float>(std::min(1.0, kBiasFaster * share));
  const auto follow_one = [&](BodyZone zone, const Vector3f& addable, const Vector3f& periodic,
                              float most, Bias& bias) {
    const float more = more_of(zone);
    const Vector3f added =
        more == 0.0f ? addable : Vector3f(saturated(more * addable, most) / more);
    const Vector3f bar = periodic_ * periodic;
    bias.rest.follow(added - bar, fast);
    bias.bar.follow(bar, slow);
    const bool is_held = zone == BodyZone::kHips || zone == BodyZone::kLegs;
    bias.value = is_held ? bias.rest.once : Vector3f(bias.rest.value() + bias.bar.value());
  };
  for (std::size_t b = 0; b < kBoneCount; ++b)
    follow_one(kZoneOfBone[b], addable_turn(b, parts), parts.periodic.turn[b], kMostAdded_rad,
               bias_[b]);
  follow_one(BodyZone::kHips, addable_sway(parts), parts.periodic.sway_m, kMostSway_m, sway_bias_);
}

Quaternionf Stylize::turned(std::size_t bone, const MotionSplit::Parts& parts, float more) const {
  const Vector3f added = saturated(more * addable_turn(bone, parts), kMostAdded_rad);
  const Vector3f kept = saturated(added - more * bias_[bone].value, kMostAdded_rad);
  const Quaternionf R = split_.turned(bone, parts.deviation.turn[bone] + come_in_ * kept);
  return bone == 0 ? (parts.R_heading * R).normalized() : R;
}

bool Stylize::is_turned(std::size_t bone, const Pose& pose) const {
  const BodyZone zone = kZoneOfBone[bone];
  // Legs step together or not at all.
  const std::uint32_t needed = zone == BodyZone::kLegs ? kLegBones : 1u << bone;
  return gain_[index_of(zone)] != 1.0f && (pose.presence & needed) == needed;
}

void Stylize::turn_bones(const MotionSplit::Parts& parts, Pose& pose) const {
  const Pose was = pose;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    if (is_turned(b, was)) pose.R_PB[b] = turned(b, parts, more_of(kZoneOfBone[b]));
  // What made a joint's turn larger may not break the joint; a dancer who goes beyond them stays as
  // far beyond.
  Pose limited = pose;
  if (limit_joints(limited) == 0) return;
  Pose within = was;
  limit_joints(within);
  for (std::size_t b = 1; b < kBoneCount; ++b)
    if (is_turned(b, was) && gain_[index_of(kZoneOfBone[b])] > 1.0f)
      pose.R_PB[b] = (limited.R_PB[b] * within.R_PB[b].conjugate() * was.R_PB[b]).normalized();
}

BodyFrames Stylize::scaled_legs(const Pose& danced, const Pose& turned_pose,
                                const MotionSplit::Parts& parts) const {
  Pose legs = danced;
  for (std::size_t b = kFirstLegBone; b < kBoneCount; ++b) legs.R_PB[b] = turned_pose.R_PB[b];
  // Hips tilt against the legs: were these scaled alone, feet would go to the side.
  legs.R_PB[0] = turned(0, parts, gain_[index_of(BodyZone::kLegs)] - 1.0f);
  // A knee that is straight does not bend the other way.
  for (const Limb& leg : kSwingLegs) {
    const std::size_t knee = index_of(leg.lower);
    Vector3f bend = rotation_vector(legs.R_PB[knee]);
    const float least = std::min(kLeastBend_rad, rotation_vector(danced.R_PB[knee]).x());
    if (bend.x() >= least) continue;
    bend.x() = least;
    legs.R_PB[knee] = exp_rotation(bend);
  }
  BodyFrames frames;
  forward_kinematics(skeleton_, legs, frames);
  return frames;
}

Vector3f Stylize::more_sway_m(const MotionSplit::Parts& parts, bool legs_are_turned) const {
  const float more = more_of(BodyZone::kHips);
  Vector3f sway = saturated(more * addable_sway(parts), kMostSway_m) - more * sway_bias_.value;
  // What the legs make of the sway, the hips make more of.
  if (legs_are_turned) sway *= std::clamp(1.0f + more_of(BodyZone::kLegs), 0.0f, kMostSwayOfLegs);
  sway = come_in_ * saturated(sway, kMostSway_m);
  sway.z() = 0.0f;  // forward and back is where the steps go
  return parts.R_heading * sway;
}

// What the sway needs is there at once, what steps need comes in its own time.
void Stylize::come_down(float needed_m, float by_steps_m, bool is_over_steps, float step_s,
                        Drop& drop) {
  const float at_once_m = std::max(0.0f, needed_m - by_steps_m);
  if (drop.is_over_steps != is_over_steps) drop.slow_m = drop.all_m - at_once_m;
  const float come_m = (1.0f - std::exp(-step_s / kDropComes_s)) * (by_steps_m - drop.slow_m);
  drop.slow_m = towards(drop.slow_m, drop.slow_m + come_m, kDropFastest_m_s * step_s);
  drop.all_m = drop.slow_m + at_once_m;
  drop.is_over_steps = is_over_steps;
}

void Stylize::show(const BodyFrames& danced, const MotionSplit::Parts& parts, float step_s,
                   Pose& pose) {
  const Pose was = pose;
  turn_bones(parts, pose);
  const bool legs_are_turned = is_turned(kFirstLegBone, was);
  const BodyFrames scaled = legs_are_turned ? scaled_legs(was, pose, parts) : danced;
  if (legs_are_scaled())
    standing_.steps.follow(feet_, danced, scaled, step_s, gain_[index_of(BodyZone::kLegs)] == 1.0f);
  const bool hips_are_scaled = gain_[index_of(BodyZone::kHips)] != 1.0f;
  const bool is_over_steps = legs_are_scaled();
  if (!hips_are_scaled && !is_over_steps) {
    standing_.drop = {};
    return;
  }
  std::array<Vector3f, 2> ankles;
  std::array<Quaternionf, 2> soles;
  std::array<float, 2> carries{1.0f, 1.0f};
  for (std::size_t side = 0; side < kSwingLegs.size(); ++side) {
    ankles[side] = danced.p_WB_m[ankle_of(side)];
    soles[side] = danced.R_WB[ankle_of(side)];
  }
  if (is_over_steps) {
    const ScaledSteps::Aim aim = standing_.steps.aim(feet_, danced, scaled);
    pose.p_WH_m += aim.hips_moved_m;
    ankles = aim.p_WAnkle_m;
    soles = aim.R_WFoot;
    for (std::size_t side = 0; side < kSwingLegs.size(); ++side) {
      pose.R_PB[ball_of(side)] = (soles[side].conjugate() * aim.R_WToes[side]).normalized();
      carries[side] = 1.0f - feet_.swing(side);
    }
  }
  const Vector3f sway =
      hips_are_scaled ? more_sway_m(parts, legs_are_turned) : Vector3f(Vector3f::Zero());
  pose.p_WH_m += sway;
  BodyFrames frames;
  forward_kinematics(skeleton_, pose, frames);
  std::array<Vector3f, 2> hip_joints{frames.position(kLeftLeg.upper),
                                     frames.position(kRightLeg.upper)};
  const float needed_m = needed_drop_m(skeleton_, scaled, hip_joints, ankles, carries);
  for (Vector3f& hip_joint : hip_joints) hip_joint -= sway;
  const float by_steps_m =
      is_over_steps ? needed_drop_m(skeleton_, scaled, hip_joints, ankles, carries) : 0.0f;
  come_down(needed_m, by_steps_m, is_over_steps, step_s, standing_.drop);
  const float drop_m = standing_.drop.all_m;
  pose.p_WH_m.y() -= drop_m;
  for (std::size_t side = 0; side < kSwingLegs.size(); ++side) {
    const Limb& leg = kSwingLegs[side];
    frames.p_WB_m[index_of(leg.upper)].y() -= drop_m;
    reach_ankle(skeleton_, leg, scaled, ankles[side], soles[side], pose, frames);
    // What is not there is left as it came.
    for (std::size_t b = index_of(leg.upper); b <= ball_of(side); ++b)
      if ((pose.presence >> b & 1u) == 0) pose.R_PB[b] = was.R_PB[b];
  }
}

}  // namespace dance

#include "producers/camera/solver/body_tracking.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/motion/joint_limits.h"
#include "producers/camera/solver/first_posture.h"
#include "producers/camera/solver/joint/joint_views.h"

namespace dance {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

constexpr double kAverageHeight_m = 1.72;
// Without a detection for so long the dancer is lost.
constexpr Duration kGone = Duration::ms(500);
// For so long it is known about how far away the dancer was.
constexpr Duration kRemembered = Duration::s(3);
constexpr double kDepthAtOnce_m = 0.2, kDepth_m_s = 0.6;
constexpr int kFirstRounds = 10, kRounds = 4, kTrustingRounds = 2;
// A fit that costs so much more than usual may be a wrong local minimum.
constexpr double kDear = 4.0, kLeastDear = 150.0;
constexpr double kClearlyBetter = 0.4;
constexpr double kUsualOver = 30.0;
// A permanently high cost is checked at this interval.
constexpr double kDoubt_s = 1.0;

// False where the network's metres were refused.
bool has_depth(const Observation& seen) {
  return std::any_of(seen.world_weight.begin(), seen.world_weight.end(),
                     [](double weight) { return weight > 0.0; });
}

}  // namespace

BodyTracking::BodyTracking(const SolverOptions& options, const Pinhole& camera,
                           std::shared_ptr<SharedPlacement> shared)
    : options_(options),
      camera_(camera),
      proportions_(options.height_m),
      shared_(std::move(shared)) {
  motion_.set_smooth(options.smooth);
  set_shape(average_lengths(options.height_m.value_or(kAverageHeight_m)));
}

void BodyTracking::set_shape(const BodyLengths& lengths) {
  lengths_ = lengths;
  const std::uint32_t version = shape_.skeleton.version;
  shape_ = options_.height_m && proportions_.is_measured() ? shape_of(lengths, *options_.height_m)
                                                           : shape_of(lengths);
  shape_.skeleton.version = version + 1;
}

void BodyTracking::reset() {
  release_scale();
  proportions_.reset();
  set_shape(average_lengths(options_.height_m.value_or(kAverageHeight_m)));
  is_tracking_ = false;
  contacts_.clear();
  forget_shown();
}

void BodyTracking::forget_shown() {
  visibility_.clear();
  feet_.clear();
  lift_.clear();
  flips_.clear();
  facing_.clear();
  hands_.clear();
}

Vector3d BodyTracking::middle_of_hips_C(const BodyState& state) {
  model_.place(shape_, state);
  return placement_.to_C(0.5 *
                         (model_.point(Landmark::kLeftHip) + model_.point(Landmark::kRightHip)));
}

bool BodyTracking::refit(BodyState& state) {
  const Observation seen = merged(problem_);
  state = first_posture(seen, shape_, placement_.R_WC());
  state.p_WH_m.setZero();
  model_.place(shape_, state);
  std::array<Vector3d, kLandmarkCount> relative_C;
  for (std::size_t i = 0; i < kLandmarkCount; ++i)
    relative_C[i] = placement_.R_WC().transpose() * model_.point(i);
  Vector3d hips_C;
  if (!place_on_all_rays(problem_, relative_C, hips_C)) return false;
  state.p_WH_m = placement_.to_W(hips_C);
  problem_.expected.state = state;
  problem_.expected.precision.setZero();
  problem_.expected.ease = rest_precision(visibility_of(seen));
  problem_.has_floor = false;
  return fit_.solve(problem_, kFirstRounds, kFirstRounds - 4, state);
}

void BodyTracking::blend_all(MonoTime now, const BodyState& from, const BodyState& to) {
  Pose carried, found;
  write_pose(from, carried);
  write_pose(to, found);
  // Another facing is turned to at a body's speed, about the vertical; the rest is blended.
  if (options_.limits_facing)
    turn_about_vertical(
        turn_between(facing_of(shape_.skeleton, carried), facing_of(shape_.skeleton, found)),
        carried);
  visibility_.blend_all(now, carried, found);
}

// What is left of a body beside another says little of how far it is, and nobody goes far
// meanwhile.
void BodyTracking::keep_depth(MonoTime now, BodyState& state) {
  const Vector3d was_C = placement_.to_C(motion_.state().p_WH_m),
                 is_C = placement_.to_C(state.p_WH_m);
  if (!(was_C.z() > 0.0) || !(is_C.z() > 0.0)) return;
  const double reach_m = kDepthAtOnce_m + kDepth_m_s * (now - seen_at_).as_seconds();
  const double depth_m = std::clamp(is_C.z(), was_C.z() - reach_m, was_C.z() + reach_m);
  if (depth_m > 0.0) state.p_WH_m = placement_.to_W(is_C * (depth_m / is_C.z()));
}

bool BodyTracking::begin(const Observation& seen, MonoTime now) {
  contacts_.clear();
  for (SoleTouch& sole : problem_.soles) sole.stands = false;
  if (!has_placement_) {
    const auto middle = [&seen](Landmark left) {
      return Vector3d(0.5 * (seen.world(left) + seen.world_m[index_of(left) + 1]));
    };
    placement_.add_upright(middle(Landmark::kLeftShoulder) - middle(Landmark::kLeftAnkle));
    placement_.update();
  }
  BodyState state;
  if (!refit(state)) return false;
  if (!has_placement_) {
    std::size_t lowest = kLandmarkCount;
    for (std::size_t i = kLandmarkCount; i < kBodyPointCount; ++i)
      if (fit_.model().point(i).y() < fit_.model().point(lowest).y()) lowest = i;
    const Vector3d lowest_C = placement_.to_C(fit_.model().point(lowest));
    const Vector3d hips_C = middle_of_hips_C(state);
    const Vector3d root_C = placement_.to_C(state.p_WH_m);
    const Matrix3d was = placement_.R_WC();
    placement_.set_initial_floor(lowest_C);
    placement_.update();
    placement_.set_origin(hips_C);
    state.p_WH_m = placement_.to_W(root_C);
    state.R_WH = Quaterniond(placement_.R_WC() * was.transpose()) * state.R_WH;
    has_placement_ = true;
    tell_shared();
  }
  if (seen_at_.is_set() && now - seen_at_ < kRemembered) keep_depth(now, state);
  // The same dancer a moment later: the shown pose is blended.
  if (is_tracking_ && now - seen_at_ <= kGone) {
    blend_all(now, motion_.state(), state);
  } else {
    forget_shown();
  }
  motion_.begin(state);
  usual_cost_ = 0.0;
  is_turned_ = false;
  is_tracking_ = true;
  return true;
}

bool BodyTracking::has_plausible_facing(Observation& seen, MonoTime now, double seconds) {
  const Expectation expected = motion_.expect(seconds, visibility_of(seen));
  model_.place(shape_, expected.state);
  const Matrix3d& R_WC = placement_.R_WC();
  const std::optional<double> expected_rad = facing_of(model_);
  const std::optional<double> seen_rad = facing_of(seen, R_WC);
  const double turn_rad = turn_between(expected_rad, seen_rad);
  // What the network would have said without the mistake.
  const double unseen_s = (now - seen_at_).as_seconds();
  std::optional<Observation> corrected;
  bool is_far = false;
  if (FlipWatch::is_suspect(turn_rad, unseen_s)) {
    corrected = without_flip(seen, R_WC, model_);
    is_far = corrected.has_value() || FlipWatch::is_far(turn_rad, unseen_s);
  }
  const FacingVerdict verdict =
      flips_.judge(seen_rad, turn_rad, is_far, corrected.has_value(), seconds, unseen_s);
  if (verdict == FacingVerdict::kLasting) is_turned_ = true;
  if (verdict != FacingVerdict::kRefused) return true;
  if (corrected) {
    seen = *corrected;
    return false;
  }
  // Where points are in the picture may be right; where they are in space is wrong.
  Observation exchanged = seen;
  exchange_sides(exchanged);
  if (ray_distance(exchanged, model_, placement_) < ray_distance(seen, model_, placement_))
    seen = exchanged;
  seen.world_weight.fill(0.0);
  return false;
}

bool BodyTracking::follow(const Observation& seen, MonoTime now, double seconds,
                          bool is_plausible) {
  const Observation all = merged(problem_);
  const PartVisibility visibility = visibility_of(all);
  const Expectation expected = motion_.expect(seconds, visibility);
  problem_.expected = expected;
  for (std::size_t i = 0; i < kSoleCount; ++i) problem_.soles[i] = contacts_.touch(i);
  BodyState state = expected.state;
  model_.place(shape_, state);
  take_far_limbs(all, placement_.R_WC(), model_, first_posture(all, shape_, placement_.R_WC()),
                 state);
  const double least_dear = kLeastDear * (1.0 + static_cast<double>(problem_.other_count));
  bool is_fitted = fit_.solve(problem_, kRounds, kTrustingRounds, state);
  const double cost = fit_.picture_cost();
  since_suspect_s_ += seconds;
  if (!is_fitted || is_turned_ ||
      (is_plausible && cost > least_dear &&
       (cost > kDear * usual_cost_ || since_suspect_s_ > kDoubt_s))) {
    since_suspect_s_ = 0.0;
    BodyState refitted;
    if (is_plausible && refit(refitted) &&
        (!is_fitted || std::exchange(is_turned_, false) ||
         fit_.picture_cost() < kClearlyBetter * cost)) {
      if (is_fitted) keep_depth(now, refitted);
      // The contacts of a wrong posture are wrong, and so may be the floor found from them.
      contacts_.clear();
      if (usual_cost_ > kLeastDear && sets_scale()) placement_.discard_feet();
      blend_all(now, expected.state, refitted);
      motion_.begin(refitted);
      visibility_.follow(visibility, seconds);
      return true;
    }
    if (!is_fitted) return false;
    problem_.expected = expected;
    problem_.has_floor = placement_.is_known() && is_of_scale();
    if (!fit_.solve(problem_, 1, 0, state)) return false;
  }
  usual_cost_ +=
      (std::min(cost, 2.0 * std::max(usual_cost_, kLeastDear)) - usual_cost_) / kUsualOver;
  visibility_.follow(visibility, seconds);
  Pose carried, found;
  write_pose(expected.state, carried);
  write_pose(state, found);
  visibility_.blend(now, carried, found);
  // Another camera has another opinion of where the body is.
  const std::size_t eyes = problem_.other_count + (seen.is_usable ? 1 : 0);
  if (eyes != std::exchange(eyes_, eyes) && problem_.other_count + eyes > 1)
    visibility_.blend_all(now, carried, found);
  motion_.follow(expected, state, seconds);
  contacts_.follow(fit_.model(), seen, placement_, seconds);
  return true;
}

void BodyTracking::carry(double seconds, MonoTime) {
  const PartVisibility blind{};
  const Expectation expected = motion_.expect(seconds, blind);
  BodyState state = expected.state;
  // Without a picture the place is kept.
  motion_.follow(expected, state, seconds);
  visibility_.follow(blind, seconds);
}

bool BodyTracking::write(const BodyState& state, MonoTime now, double seconds, Pose& out) {
  Pose pose = out;
  write_pose(state, pose);
  limit_joints(pose);
  visibility_.apply(now, pose);
  if (options_.limits_facing) facing_.apply(shape_.skeleton, seconds, pose);
  if (options_.holds_feet)
    feet_.apply(shape_, contacts_, placement_.is_known(), !facing_.is_behind(), seconds, pose);
  if (options_.keeps_above_floor) lift_.apply(shape_, placement_.is_known(), seconds, pose);
  const Observation seen = merged(problem_);
  if (options_.steadies_hands)
    hands_.apply(shape_.skeleton,
                 hand_measurement(problem_, visibility_of(seen), pose.p_WH_m.cast<double>()),
                 seconds, pose);
  pose.presence = visibility_.presence();
  pose.confidence = static_cast<float>(std::clamp(seen.visible, 0.0, 1.0));
  pose.capture_time = now;
  if (options_.is_mirrored) mirror(pose);
  normalize(pose);
  if (!is_valid(pose)) {
    is_tracking_ = false;
    return false;
  }
  out = pose;
  return true;
}

void BodyTracking::look_at_others(OtherViews others, MonoTime now, double seconds) {
  take_views(others, problem_);
  if (problem_.other_count == 0 || !is_tracking_) return;
  const Expectation expected = motion_.expect(seconds, visibility_of(merged(problem_)));
  align_views(motion_, expected, shape_, (now - seen_at_).as_seconds(), model_, problem_);
  // The floor was learned with the depth that one camera has.
  if (problem_.other_count > 0 && !std::exchange(has_seen_others_, true))
    placement_.relearn_floor();
}

bool BodyTracking::solve(const BodyLandmarks& landmarks, const std::optional<DepthHint>& depth,
                         Pose& out, OtherViews others) {
  const MonoTime now = landmarks.capture_time;
  if (time_.is_set() && now <= time_) return false;
  const double seconds = (now - time_).as_seconds();
  take_shared();
  Observation seen = observe(landmarks, camera_);
  problem_.seen = &seen;
  problem_.camera = &placement_;
  problem_.shape = &shape_;
  problem_.has_floor = placement_.is_known() && is_of_scale();
  problem_.depth.reset();
  if (depth && depth->joints > 0 && std::isfinite(depth->hips_depth_m) &&
      depth->hips_depth_m > 0.2 && std::isfinite(depth->spread_m))
    problem_.depth = depth;
  if (is_tracking_ && now - seen_at_ > kGone) is_tracking_ = false;
  time_ = now;
  look_at_others(others, now, seconds);
  const bool has_others = is_tracking_ && problem_.other_count > 0;
  if (!seen.is_usable && !has_others) {
    if (!is_tracking_) return false;
    carry(seconds, now);
    return write(motion_.state(), now, seconds, out);
  }
  if (seen.is_usable) claim_scale();
  // A dancer that was detected again a moment later is judged as one that was followed.
  const bool is_plausible =
      !is_tracking_ || !options_.limits_facing || has_plausible_facing(seen, now, seconds);
  const bool is_same =
      is_tracking_ && (!landmarks.is_new || has_others || (!is_plausible && !has_depth(seen)));
  const bool is_found = is_same ? follow(seen, now, seconds, is_plausible) : begin(seen, now);
  if (!is_found) {
    is_tracking_ = false;
    return false;
  }
  seen_at_ = now;
  if (is_plausible && seen.is_usable) {
    learn_camera(seen);
    learn_bones(seen, depth, now);
  }
  return write(motion_.state(), now, seconds, out);
}

}  // namespace dance

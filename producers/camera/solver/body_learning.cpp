// What BodyTracking learns of the dancer and the camera: bones, floor and placement.
#include <algorithm>
#include <cmath>
#include <utility>

#include "producers/camera/solver/body_tracking.h"
#include "producers/camera/solver/joint/joint_views.h"

namespace dance {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

// How much another height a floor can make of a dancer's, and by how many standing soles.
constexpr double kMostGrowth = 1.25;
constexpr int kLeastGrowths = 20;

}  // namespace

// Those of a dancer who stands on the floor that another has scaled.
BodyLengths BodyTracking::lengths_on_floor() const {
  const BodyLengths lengths = proportions_.lengths();
  if (sets_scale() || options_.height_m || growths_ < kLeastGrowths) return lengths;
  // They were seen with the bones of now.
  const double by = growth_sum_ / growths_ *
                    static_cast<double>(standing_height_m(shape_.skeleton)) / height_of(lengths);
  return scaled(lengths, by);
}

void BodyTracking::learn_bones(const Observation& seen, const std::optional<DepthHint>& depth,
                               MonoTime now) {
  if (proportions_.is_held()) return;
  const int before = proportions_.pictures();
  model_.place(shape_, motion_.state());
  std::array<Vector3d, kLandmarkCount> pictured;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const double z = placement_.to_C(model_.point(i)).z();
    pictured[i] = {seen.ray[i].x() * z, seen.ray[i].y() * z, z};
  }
  proportions_.see(seen, pictured, depth);
  const int pictures = proportions_.pictures();
  const bool is_due =
      pictures != before && (pictures == Proportions::kFirst || pictures == Proportions::kHeld);
  if (!is_due) return;
  grow_to(lengths_on_floor(), now);
  growth_sum_ = 0.0;
  growths_ = 0;
}

void BodyTracking::take_lengths(const BodyLengths& lengths) {
  proportions_.hold(lengths);
  if (!is_tracking_) return set_shape(lengths);
  grow_to(lengths, time_);
}

void BodyTracking::grow_to(const BodyLengths& lengths, MonoTime now) {
  model_.place(shape_, motion_.state());
  const double was_lowest_m = lowest_sole_m();
  const double was_m = static_cast<double>(standing_height_m(shape_.skeleton));
  BodyState state = motion_.state();
  Pose carried, found;
  write_pose(state, carried);
  const Vector3d hips_C = placement_.to_C(state.p_WH_m);
  set_shape(lengths);
  proportions_.discard_image_lengths();
  // A larger body in the same picture is further away, and the floor with it, unless another dancer
  // says how far that is.
  const double by = static_cast<double>(standing_height_m(shape_.skeleton)) / was_m;
  const CameraPlacement was = placement_;
  if (sets_scale()) {
    placement_.scale(by);
    if (shared_) scale_ = shared_->scale *= by;
    tell_shared();
  }
  state.p_WH_m = placement_.to_W(hips_C * by);
  contacts_.rebase([&](const Vector3d& p) { return placement_.to_W(was.to_C(p) * by); });
  motion_.rebase(state);
  write_pose(state, found);
  if (options_.keeps_above_floor) {
    // Soles keep their height while the bones grow, not the hips.
    model_.place(shape_, state);
    carried.p_WH_m.y() = found.p_WH_m.y() + static_cast<float>(was_lowest_m - lowest_sole_m());
  }
  visibility_.blend_all(now, carried, found);
}

double BodyTracking::lowest_sole_m() const {
  double lowest_m = model_.point(kLandmarkCount).y();
  for (std::size_t i = kLandmarkCount + 1; i < kBodyPointCount; ++i)
    lowest_m = std::min(lowest_m, model_.point(i).y());
  return lowest_m;
}

void BodyTracking::learn_camera(const Observation& seen) {
  const auto middle = [&seen](Landmark left) {
    return Vector3d(0.5 * (seen.world(left) + seen.world_m[index_of(left) + 1]));
  };
  if (seen.visible > 0.8)
    placement_.add_upright(middle(Landmark::kLeftShoulder) - middle(Landmark::kLeftAnkle));
  // The place by the picture alone: the floor that is being estimated must not influence it.
  BodyState state = motion_.state();
  model_.place(shape_, state);
  std::array<Vector3d, kLandmarkCount> relative_C;
  const Matrix3d R_CW = placement_.R_WC().transpose();
  for (std::size_t i = 0; i < kLandmarkCount; ++i)
    relative_C[i] = R_CW * (model_.point(i) - state.p_WH_m);
  Vector3d hips_C;
  if (place_on_all_rays(problem_, relative_C, hips_C))
    for (std::size_t i = 0; i < kSoleCount; ++i) {
      if (!contacts_.touch(i).stands) continue;
      const Vector3d sole_C = hips_C + R_CW * (model_.point(kLandmarkCount + i) - state.p_WH_m);
      if (is_of_scale()) {
        placement_.add_foot(sole_C);
      } else if (const auto growth = placement_.growth_to_floor(sole_C);
                 growth && placement_.is_known()) {
        growth_sum_ += std::clamp(*growth, 1.0 / kMostGrowth, kMostGrowth);
        ++growths_;
      }
    }
  const CameraPlacement was = placement_;
  placement_.update();
  rebase(was, state);
  tell_shared();
}

void BodyTracking::rebase(const CameraPlacement& was, BodyState state) {
  const auto again = [&](const Vector3d& p) { return placement_.to_W(was.to_C(p)); };
  state.p_WH_m = again(state.p_WH_m);
  state.R_WH = (Quaterniond(placement_.R_WC() * was.R_WC().transpose()) * state.R_WH).normalized();
  contacts_.rebase(again);
  motion_.rebase(state);
}

void BodyTracking::take_shared() {
  if (!shared_ || shared_->version == shared_version_) return;
  const CameraPlacement was = placement_;
  placement_ = shared_->placement;
  shared_version_ = shared_->version;
  const double by = shared_->scale / std::exchange(scale_, shared_->scale);
  if (has_placement_ && is_tracking_) rebase(was, motion_.state());
  has_placement_ = true;
  // The floor is further away, and so is who stands on it; unless they said how tall they are.
  if (by == 1.0 || sets_scale() || options_.height_m || !is_tracking_) return;
  grow_to(scaled(lengths_, by), time_);
}

// The first who is seen sets the scale, until one is seen whose height was told.
void BodyTracking::claim_scale() {
  if (!shared_ || (shared_->scaled_by && (!options_.height_m || shared_->is_told))) return;
  shared_->scaled_by = this;
  shared_->is_told = options_.height_m.has_value();
}

void BodyTracking::release_scale() {
  growth_sum_ = 0.0;
  growths_ = 0;
  if (!shared_ || shared_->scaled_by != this) return;
  shared_->scaled_by = nullptr;
  shared_->is_told = false;
}

void BodyTracking::tell_shared() {
  if (!shared_) return;
  shared_->placement = placement_;
  shared_version_ = ++shared_->version;
}

}  // namespace dance

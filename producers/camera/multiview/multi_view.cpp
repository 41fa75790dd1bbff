#include "producers/camera/multiview/multi_view.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "producers/camera/solver/joint/joint_views.h"

namespace dance {
namespace {

// In so long a camera that was placed, or sees the dancer again, comes to its full weight: over
// three decades.
constexpr double kComes_s = 1.0;
constexpr double kLeastShare = 1e-3;
// Half of a usual change of speed, as rays at three metres; `dance capture several eval` tuned it.
constexpr double kChange_rays_s2 = 1.0;

}  // namespace

void MultiView::add_camera(const Pinhole& camera) {
  DANCE_ASSERT(others_.size() < kMostOtherViews, others_.size());
  others_.push_back(std::make_unique<Other>());
  others_.back()->lens = camera;
}

void MultiView::see_other(std::size_t camera, const BodyLandmarks& body) {
  Other& other = *others_[camera];
  if (!body.found) return;
  other.seen = observe(body, other.lens);
  other.seen_time = body.capture_time;
  if (other.seen.is_usable) other.pair.see_other(view_points(other.seen, body.capture_time));
}

OtherViews MultiView::see_first(const BodyLandmarks& body, const DancerSize& size) {
  ViewPoints points;
  points.time = body.capture_time;
  if (body.found) points = view_points(observe(body, first_), body.capture_time);
  std::size_t count = 0;
  for (const auto& other : others_) {
    other->pair.see_first(points, size);
    if (write_view(*other, body.capture_time, views_[count])) ++count;
  }
  return {views_.data(), count};
}

bool MultiView::write_view(Other& other, MonoTime now, OtherView& out) {
  const double passed_s =
      other.trust_time.is_set() ? std::clamp((now - other.trust_time).as_seconds(), 0.0, 1.0) : 0.0;
  other.trust_time = now;
  const auto& placement = other.pair.placement();
  if (!placement || !other.seen_time.is_set()) {
    other.trust = 0.0;
    return false;
  }
  const RelativePose& pose = placement->pose;
  out.older_s = (now - other.seen_time).as_seconds() + pose.later_s;
  if (!other.seen.is_usable || std::abs(out.older_s) > kOldestView_s) {
    other.trust = 0.0;
    return false;
  }
  other.trust = std::min(1.0, other.trust + passed_s / kComes_s);
  out.seen = other.seen;
  out.R_VC = pose.R_BA;
  out.p_VC_m = placement->baseline_m * pose.p_BA;
  // What rays miss each other by beyond their noise, and how far a body goes that changes its
  // speed.
  const double beyond = std::max(0.0, placement->spread * placement->spread - 1.0);
  out.placement_sd = std::hypot(other.seen.ray_sd * std::sqrt(beyond),
                                kChange_rays_s2 * out.older_s * out.older_s);
  out.trust = std::pow(kLeastShare, 1.0 - other.trust);
  return true;
}

std::optional<BodyLengths> MultiView::take_lengths() {
  std::optional<BodyLengths> lengths;
  for (const auto& other : others_)
    if (auto taken = other->pair.take_lengths()) lengths = taken;
  return lengths;
}

}  // namespace dance

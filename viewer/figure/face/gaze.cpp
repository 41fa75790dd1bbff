#include "viewer/figure/face/gaze.h"

#include <algorithm>
#include <cmath>

#include "viewer/figure/face/guest_noise.h"

namespace dance {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kFurthest_m = 6.0f;
constexpr float kSwitches = 0.75f;  // another dancer at less than this share of the distance
// Up to the first angle the eyes turn as far as they can. Beyond it they turn back; at the second
// they look straight ahead.
constexpr float kFrontEnds_rad = 0.9f, kSideBegins_rad = 1.3f;
constexpr float kLinear = 0.75f;  // of the range; the rest is approached and never reached

constexpr std::int64_t kFixation_ns = 1'150'000'000;
constexpr double kJump_s = 0.04;
// About half of a face at arm's length.
constexpr double kJumpAside_rad = 0.055, kJumpUp_rad = 0.04;
constexpr std::uint64_t kWhenStream = 1, kAsideStream = 2, kUpStream = 3;

float saturated(float angle, float most) {
  const float free = kLinear * most, room = most - free, size = std::abs(angle);
  if (size <= free) return angle;
  return std::copysign(free + room * (1.0f - std::exp((free - size) / room)), angle);
}

}  // namespace

Vector2f aim_gaze(const DancerView& from, const Vector3f& target_W_m) {
  const Vector3f to = from.R_WH.conjugate() * (target_W_m - from.eyes_W_m);
  if (to.norm() < 1e-3f) return Vector2f::Zero();
  return {std::atan2(to.x(), to.z()), std::atan2(to.y(), std::hypot(to.x(), to.z()))};
}

Vector2f limit_gaze(const Vector2f& aimed_rad) {
  const float in_front = smooth_between(kSideBegins_rad, kFrontEnds_rad, std::abs(aimed_rad.x()));
  const float up = aimed_rad.y() > 0.0f ? kMostGazeUp_rad : kMostGazeDown_rad;
  return in_front *
         Vector2f(saturated(aimed_rad.x(), kMostGazeAside_rad), saturated(aimed_rad.y(), up));
}

std::size_t find_gaze_partner(std::span<const DancerView> views, std::size_t self,
                              const GuestId& kept) {
  const DancerView& from = views[self];
  std::size_t best = views.size();
  float best_m = kFurthest_m;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].id == from.id) continue;
    float apart_m = (views[i].eyes_W_m - from.eyes_W_m).norm();
    if (views[i].id == kept) apart_m *= kSwitches;
    if (apart_m >= best_m) continue;
    if (std::abs(aim_gaze(from, views[i].eyes_W_m).x()) > kSideBegins_rad) continue;
    best = i;
    best_m = apart_m;
  }
  return best;
}

Vector2f saccade_at(const GuestId& guest, MonoTime time) {
  const GuestNoise when(guest, kWhenStream), aside(guest, kAsideStream), up(guest, kUpStream);
  const GuestNoise::Moment at = GuestNoise::moment_of(time, kFixation_ns);
  const double begins_s =
      (1e-9 * static_cast<double>(kFixation_ns) - kJump_s) * when.draw(at.period);
  const double moved = smooth_step((at.s - begins_s) / kJump_s);
  const auto between = [&](const GuestNoise& noise) {
    const double from = noise.draw(at.period - 1), to = noise.draw(at.period);
    return 2.0 * (from + (to - from) * moved) - 1.0;
  };
  return {static_cast<float>(kJumpAside_rad * between(aside)),
          static_cast<float>(kJumpUp_rad * between(up))};
}

}  // namespace dance

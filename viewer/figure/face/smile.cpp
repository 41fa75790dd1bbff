#include "viewer/figure/face/smile.h"

#include <algorithm>

#include "viewer/figure/face/guest_noise.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr float kNear_m = 0.9f, kFar_m = 1.8f;
constexpr float kHeld_m = 0.13f, kLetGo_m = 0.3f;
// Cosine of the angle between the chest's direction and the direction of the partner.
constexpr float kFaces = 0.6f, kFacesAway = -0.2f;
constexpr float kByFacing = 0.45f, kByHands = 0.3f, kByBeat = 0.25f;
// A smile varies over a song.
constexpr std::int64_t kMood_ns = 5'300'000'000;
constexpr float kMood = 0.3f;
constexpr std::uint64_t kMoodStream = 4;

float facing(const DancerView& from, const Vector3f& direction_W) {
  return smooth_between(kFacesAway, kFaces, from.facing_W.dot(direction_W));
}

float held_hands(const DancerView& a, const DancerView& b) {
  float apart_m = kLetGo_m;
  for (const Vector3f& mine : a.palms_W_m)
    for (const Vector3f& theirs : b.palms_W_m) apart_m = std::min(apart_m, (mine - theirs).norm());
  return smooth_between(kLetGo_m, kHeld_m, apart_m);
}

}  // namespace

float enjoyment_of(const DancerView& a, const DancerView& b) {
  Vector3f apart = b.hips_W_m - a.hips_W_m;
  apart.y() = 0.0f;
  const float apart_m = apart.norm();
  if (apart_m >= kFar_m) return 0.0f;
  const Vector3f direction = apart_m > 1e-3f ? Vector3f(apart / apart_m) : a.facing_W;
  return smooth_between(kFar_m, kNear_m, apart_m) *
         (kByFacing * facing(a, direction) * facing(b, -direction) + kByHands * held_hands(a, b) +
          kByBeat * a.on_beat);
}

float smile_towards(std::span<const DancerView> views, std::size_t self, MonoTime time) {
  float best = 0.0f;
  for (const DancerView& other : views)
    if (other.id != views[self].id) best = std::max(best, enjoyment_of(views[self], other));
  if (best <= 0.0f) return 0.0f;
  const float mood = GuestNoise(views[self].id, kMoodStream).drift(time, kMood_ns);
  return kMostSmile * best * (1.0f - kMood * mood);
}

}  // namespace dance

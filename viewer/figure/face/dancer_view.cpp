#include "viewer/figure/face/dancer_view.h"

#include <cmath>

namespace dance {
namespace {

using Eigen::Vector3f;

// Distance from the beat: up to the first it counts fully as on the beat, from the second not at
// all.
constexpr float kOnBeat_ms = 60.0f, kOffBeat_ms = 140.0f;
constexpr float kSteady_ms = 45.0f, kUnsteady_ms = 110.0f;

float on_beat(const std::optional<BeatFigures>& beat) {
  if (!beat) return 0.0f;
  return smooth_between(kOffBeat_ms, kOnBeat_ms, std::abs(beat->behind_ms)) *
         smooth_between(kUnsteady_ms, kSteady_ms, beat->wander_ms);
}

}  // namespace

DancerView view_of(const SceneGuest& guest, const FigureFit& fit) {
  DancerView view;
  view.id = guest.id;
  view.R_WH = fit.R_W(Bone::kHead);
  view.eyes_W_m = fit.frames.position(Bone::kHead) + view.R_WH * fit.rig->eyes_m;
  view.hips_W_m = fit.frames.position(Bone::kHips);
  const Vector3f forward = fit.R_W(Bone::kChest) * Vector3f::UnitZ();
  const Vector3f on_floor(forward.x(), 0.0f, forward.z());
  if (on_floor.norm() > 1e-3f) view.facing_W = on_floor.normalized();
  for (std::size_t side = 0; side < 2; ++side) view.palms_W_m[side] = fit.palm_W_m(side);
  view.on_beat = on_beat(guest.figures.beat);
  return view;
}

}  // namespace dance

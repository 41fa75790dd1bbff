#include "testing/xr/script/xr_scene.h"

#include <algorithm>
#include <limits>

namespace dance::test_xr {
namespace {

Keyframe keyframe_at(const std::vector<Keyframe>& keyframes, double time_s) {
  const auto next =
      std::upper_bound(keyframes.begin(), keyframes.end(), time_s,
                       [](double t_s, const Keyframe& frame) { return t_s < frame.time_s; });
  if (next == keyframes.begin()) return keyframes.front();
  if (next == keyframes.end()) return keyframes.back();
  const Keyframe& a = *(next - 1);
  const double part = (time_s - a.time_s) / (next->time_s - a.time_s);
  return {time_s, a.p_m + part * (next->p_m - a.p_m), a.R.slerp(part, next->R)};
}

void garble(const PointTrack& track, double time_s, PointState& state) {
  for (const GarbledPose& garbled : track.garbled) {
    if (time_s < garbled.time_s || time_s >= garbled.time_s + kGarbledTime_s) continue;
    if (garbled.is_nan)
      state.p_m.setConstant(std::numeric_limits<double>::quiet_NaN());
    else
      state.R.coeffs().setZero();
  }
}

}  // namespace

PointState point_at(const XrScript& script, TrackedPoint point, double time_s) {
  const PointTrack& track = script.points[index_of(point)];
  PointState state;
  if (!is_connected_at(script, point, time_s)) return state;
  const Keyframe now = keyframe_at(track.keyframes, time_s);
  constexpr double kStep_s = 0.004;
  const Keyframe before = keyframe_at(track.keyframes, time_s - kStep_s);
  const Keyframe after = keyframe_at(track.keyframes, time_s + kStep_s);
  state.p_m = now.p_m;
  state.R = now.R;
  state.v_mps = (after.p_m - before.p_m) / (2.0 * kStep_s);
  const Eigen::AngleAxisd turn(after.R * before.R.conjugate());
  state.w_radps = turn.axis() * turn.angle() / (2.0 * kStep_s);
  state.tracking = Tracking::kTracked;
  for (const TrackingChange& change : track.changes)
    if (change.time_s <= time_s) state.tracking = change.tracking;
  garble(track, time_s, state);
  return state;
}

std::array<float, 2> input_at(const XrScript& script, Hand hand, Input input, double time_s) {
  std::array<float, 2> value{};
  for (const InputChange& change : script.inputs)
    if (change.time_s <= time_s && change.hand == hand && change.input == input)
      value = {change.x, change.y};
  return value;
}

bool is_fist_at(const XrScript& script, double time_s) {
  bool is_fist = false;
  for (const ShapeChange& change : script.shapes)
    if (change.time_s <= time_s) is_fist = change.is_fist;
  return is_fist;
}

bool is_connected_at(const XrScript& script, TrackedPoint point, double time_s) {
  const auto& keyframes = script.points[index_of(point)].keyframes;
  const bool is_basic = point <= TrackedPoint::kRightHand;
  return !keyframes.empty() && (is_basic || time_s >= keyframes.front().time_s);
}

}  // namespace dance::test_xr

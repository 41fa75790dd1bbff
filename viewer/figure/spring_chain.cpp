#include "viewer/figure/spring_chain.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kStep_s = 1.0f / 120.0f;
constexpr float kForces_hz = 60.0f;  // VRM's forces are of a picture of 1/60 s

Quaternionf mixed(const Quaternionf& a, const Quaternionf& b, float share) {
  const float sign = a.dot(b) < 0.0f ? -1.0f : 1.0f;
  return Quaternionf((1.0f - share) * a.coeffs() + sign * share * b.coeffs()).normalized();
}

Quaternionf turn_of(const Vector3f& from, const Vector3f& to) {
  const float w = from.norm() * to.norm() + from.dot(to);
  if (w < 1e-6f * from.squaredNorm()) {
    const Vector3f axis = from.unitOrthogonal();
    return Quaternionf(0.0f, axis.x(), axis.y(), axis.z());
  }
  const Vector3f axis = from.cross(to);
  return Quaternionf(w, axis.x(), axis.y(), axis.z()).normalized();
}

Vector3f nearest_on(const Vector3f& a, const Vector3f& b, const Vector3f& point) {
  const Vector3f along = b - a;
  const float length2 = along.squaredNorm();
  if (length2 < 1e-12f) return a;
  return a + std::clamp(along.dot(point - a) / length2, 0.0f, 1.0f) * along;
}

Vector3f at_length(const Vector3f& from, const Vector3f& to, float length, const Vector3f& usual) {
  const Vector3f along = to - from;
  const float is = along.norm();
  return is > 1e-6f ? Vector3f(from + along * (length / is)) : Vector3f(from + usual);
}

Vector3f place_of(const AvatarRig& rig, std::size_t driver, const SwingNode& node,
                  const DriverPose& parent) {
  return parent.place_W_m + rig.scale * (parent.D * (rig.shape->drivers_M_m[driver] -
                                                     rig.shape->drivers_M_m[node.parent]));
}

}  // namespace

void SpringChains::start(const AvatarRig& rig) {
  const AvatarShape& shape = *rig.shape;
  states_.resize(shape.swings.size());
  before_.resize(shape.drivers_M_m.size());
  state_of_.assign(shape.drivers_M_m.size(), -1);
  work_ = 0;
  for (std::size_t i = 0; i < shape.swings.size(); ++i) {
    state_of_[shape.swings[i].driver] = static_cast<int>(i);
    work_ += 1 + shape.swings[i].collider_count;
  }
  is_moving_ = false;
}

DriverPose SpringChains::between(std::size_t driver, float share,
                                 std::span<const DriverPose> drivers) const {
  const int state = state_of_[driver];
  if (state >= 0) return states_[static_cast<std::size_t>(state)].pose;
  const DriverPose &a = before_[driver], &b = drivers[driver];
  return {mixed(a.D, b.D, share), a.place_W_m + share * (b.place_W_m - a.place_W_m)};
}

void SpringChains::rest(const AvatarRig& rig, std::span<const DriverPose> drivers) {
  const AvatarShape& shape = *rig.shape;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const SwingNode& node = shape.swings[i];
    State& state = states_[i];
    const int above = state_of_[node.parent];
    const DriverPose parent =
        above >= 0 ? states_[static_cast<std::size_t>(above)].pose : drivers[node.parent];
    state.turn = state.turn_before = Quaternionf::Identity();
    state.pose = {parent.D, place_of(rig, node.driver, node, parent)};
    state.end_W_m = state.end_before_W_m =
        state.pose.place_W_m + rig.scale * (parent.D * node.tail_M_m);
    if (node.centre >= 0) {
      const auto centre = static_cast<std::size_t>(node.centre);
      const int swings = state_of_[centre];
      state.centre = swings >= 0 ? states_[static_cast<std::size_t>(swings)].pose : drivers[centre];
    }
  }
}

Vector3f SpringChains::end_after(const AvatarRig& rig, const SwingNode& node, const State& state,
                                 const Vector3f& place, const Vector3f& rest, float share,
                                 std::span<const DriverPose> drivers) const {
  const AvatarShape& shape = *rig.shape;
  const float length = rest.norm();
  const float kept = std::pow(1.0f - node.drag, kForces_hz * kStep_s);
  const float forces = kForces_hz * kStep_s * kStep_s * rig.scale;
  Vector3f end = state.end_W_m + kept * (state.end_W_m - state.end_before_W_m) +
                 forces * (node.stiffness / length * rest + node.gravity);
  end = at_length(place, end, length, rest);
  for (std::uint32_t c = 0; c < node.collider_count; ++c) {
    const SwingCollider& collider = shape.colliders[node.first_collider + c];
    const DriverPose body = between(collider.driver, share, drivers);
    const Vector3f& origin = shape.drivers_M_m[collider.driver];
    const auto in_W = [&](const Vector3f& point_M) {
      return Vector3f(body.place_W_m + rig.scale * (body.D * (point_M - origin)));
    };
    const Vector3f centre = nearest_on(in_W(collider.centre_M_m), in_W(collider.tail_M_m), end);
    const float radius = rig.scale * (collider.radius_m + node.radius_m);
    const Vector3f out = end - centre;
    const float distance = out.norm();
    if (distance >= radius || distance < 1e-6f) continue;
    end = at_length(place, centre + out * (radius / distance), length, rest);
  }
  return end.allFinite() ? end : Vector3f(place + rest);
}

void SpringChains::step(const AvatarRig& rig, float share, std::span<const DriverPose> drivers) {
  const AvatarShape& shape = *rig.shape;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const SwingNode& node = shape.swings[i];
    State& state = states_[i];
    const DriverPose parent = between(node.parent, share, drivers);
    if (node.centre >= 0) {  // it swings in the axes of its centre: taken along by that
      const DriverPose centre = between(static_cast<std::size_t>(node.centre), share, drivers);
      const Quaternionf turn = centre.D * state.centre.D.conjugate();
      for (Vector3f* end : {&state.end_W_m, &state.end_before_W_m})
        *end = centre.place_W_m + turn * (*end - state.centre.place_W_m);
      state.centre = centre;
    }
    const Vector3f place = place_of(rig, node.driver, node, parent);
    const Vector3f rest = rig.scale * (parent.D * node.tail_M_m);
    const Vector3f end = end_after(rig, node, state, place, rest, share, drivers);
    state.end_before_W_m = state.end_W_m;
    state.end_W_m = end;
    state.turn_before = state.turn;
    state.turn = turn_of(node.tail_M_m, parent.D.conjugate() * (end - place));
    state.pose = {(parent.D * state.turn).normalized(), place};
  }
}

void SpringChains::show(const AvatarRig& rig, float share, std::span<DriverPose> drivers) const {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const SwingNode& node = rig.shape->swings[i];
    const DriverPose& parent = drivers[node.parent];
    const Quaternionf turn = mixed(states_[i].turn_before, states_[i].turn, share);
    drivers[node.driver] = {(parent.D * turn).normalized(),
                            place_of(rig, node.driver, node, parent)};
  }
}

void SpringChains::stay(const AvatarRig& rig, MonoTime now, std::span<DriverPose> drivers) {
  is_moving_ = false;
  swing(rig, now, drivers);
}

void SpringChains::swing(const AvatarRig& rig, MonoTime now, std::span<DriverPose> drivers) {
  if (states_.empty()) return;
  const std::int64_t steps = now.since_zero_ns() / kStep.count_ns();
  const Duration passed = now - time_;
  const bool is_continuous =
      is_moving_ && passed >= Duration() && passed <= kLongestPause &&
      (drivers[0].place_W_m - before_[0].place_W_m).norm() <= kFurthestJump_m;
  if (!is_continuous) rest(rig, drivers);
  for (std::int64_t s = steps_ + 1; is_continuous && s <= steps; ++s) {
    const Duration into = MonoTime::from_ns(s * kStep.count_ns()) - time_;
    step(rig, static_cast<float>(into.as_seconds() / passed.as_seconds()), drivers);
  }
  const Duration past = now - MonoTime::from_ns(steps * kStep.count_ns());
  show(rig, static_cast<float>(past.as_seconds() / kStep.as_seconds()), drivers);
  std::ranges::copy(drivers, before_.begin());
  time_ = now;
  steps_ = steps;
  is_moving_ = true;
}

}  // namespace dance

#include "producers/xr/xr_sensors.h"

#include "core/pose/heading.h"

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

constexpr Duration kOldestBody = Duration::ms(300);

// Points that a body without legs stands for.
struct PointOfBone {
  TrackedPoint point;
  Bone place, turn;
};
// An elbow is the end of the upper arm, and turns with it.
constexpr std::array<PointOfBone, 4> kPointsOfBody{
    {{TrackedPoint::kHips, Bone::kHips, Bone::kHips},
     {TrackedPoint::kChest, Bone::kUpperChest, Bone::kUpperChest},
     {TrackedPoint::kLeftElbow, Bone::kLeftLowerArm, Bone::kLeftUpperArm},
     {TrackedPoint::kRightElbow, Bone::kRightLowerArm, Bone::kRightUpperArm}}};

TrackedPoint point_of(XrHand hand) {
  return hand == XrHand::kLeft ? TrackedPoint::kLeftHand : TrackedPoint::kRightHand;
}

}  // namespace

Quaternionf XrPlacement::turn() const { return about_up(turn_rad); }

XrPlace XrPlacement::in_house(const XrPlace& in_base) const {
  return {in_house(in_base.p_m), (turn() * in_base.R).normalized()};
}

XrPlacement moved(const XrPlacement& placement, const XrPlace& new_in_old) {
  return {placement.turn_rad + heading_rad(new_in_old.R), placement.in_house(new_in_old.p_m)};
}

std::optional<XrSpot> spot_of(const XrPlace& head) {
  constexpr float kLeastLevel = 0.3f;
  const Vector3f looks = head.R * -Vector3f::UnitZ();
  if (std::hypot(looks.x(), looks.z()) < kLeastLevel) return std::nullopt;
  return XrSpot{head.p_m.x(), head.p_m.z(), std::atan2(looks.x(), looks.z())};
}

XrPlacement placement_of(const XrPlace& head_in_base, const XrSpot& spot, float floor_m) {
  const Vector3f looks = head_in_base.R * -Vector3f::UnitZ();
  XrPlacement placement;
  placement.turn_rad = spot.heading_rad - std::atan2(looks.x(), looks.z());
  const Vector3f head = placement.turn() * head_in_base.p_m;
  placement.shift_m = Vector3f(spot.x_m - head.x(), -floor_m, spot.z_m - head.z());
  return placement;
}

XrSensors::XrSensors(const XrDancerSession& session, const XrInput& input)
    : session_(session), input_(input) {
  if (session.runtime().sees_hands()) {
    auto made = XrHands::create(session);
    if (made)
      hands_ = std::move(*made);
    else
      note_ = made.error().what;
  }
  auto made = XrBody::create(session);
  if (made)
    body_ = std::move(*made);
  else
    note_ = made.error().what;
}

void XrSensors::look(XrTime time, MonoTime moment, const XrPlacement& placement, XrSight& sight) {
  sight.points = TrackerFrame();
  sight.points.time = moment;
  sight.hands.presence = 0;
  sight.has_figure = false;
  const auto put = [&](TrackedPoint point, const std::optional<XrPlace>& in_base) {
    if (!in_base) return;
    const XrPlace place = placement.in_house(*in_base);
    sight.points.put(point, place.p_m, place.R);
  };
  put(TrackedPoint::kHead, input_.head(time));
  for (std::size_t i = index_of(TrackedPoint::kHips); i < kTrackedPointCount; ++i)
    put(static_cast<TrackedPoint>(i), input_.tracker(static_cast<TrackedPoint>(i), time));
  look_at_hands(time, placement, sight);
  look_at_body(time, placement, sight);
}

void XrSensors::look_at_hands(XrTime time, const XrPlacement& placement, XrSight& sight) {
  for (const XrHand hand : {XrHand::kLeft, XrHand::kRight}) {
    const auto i = static_cast<std::size_t>(hand);
    auto grip = input_.grip(hand, time);
    const auto joints = hands_ ? hands_->see(hand, time) : std::nullopt;
    // Where a controller is held, some runtimes tell fingers by its buttons; while it is out of
    // sight the hand is not bare.
    if (joints) write_fingers(*joints, hand, sight.hands);
    sight.is_bare[i] = joints && !input_.holds(hand);
    sight.is_pinching[i] = sight.is_bare[i] && is_pinching(*joints);
    if (sight.is_bare[i]) {
      grip = grip_of(*joints, hand);
      sight.bare_aims_W[i] = placement.in_house(aim_of(*joints));
      sight.fingertips_W_m[i] = placement.in_house(joints->at(XR_HAND_JOINT_INDEX_TIP_EXT).p_m);
    }
    if (!grip) continue;
    const XrPlace place = placement.in_house(*grip);
    sight.points.put(point_of(hand), place.p_m, place.R);
  }
}

// A runtime's word, where it can be true.
MonoTime XrSensors::moment_of(XrTime seen, MonoTime asked) const {
  const MonoTime moment = session_.runtime().mono_of(seen);
  const bool can_be = moment.is_set() && asked - moment < kOldestBody && moment <= asked;
  return can_be ? moment : asked;
}

void XrSensors::look_at_body(XrTime time, const XrPlacement& placement, XrSight& sight) {
  XrTime seen = time;
  if (!body_ || !body_->see(time, sight.figure, seen)) return;
  sight.figure_moment = moment_of(seen, sight.points.time);
  for (std::size_t i = 0; i < kBoneCount; ++i) {
    const XrPlace place = placement.in_house(XrPlace{sight.figure.p_WB_m[i], sight.figure.R_WB[i]});
    sight.figure.p_WB_m[i] = place.p_m;
    sight.figure.R_WB[i] = place.R;
  }
  sight.has_figure = body_->has_legs();
  if (sight.has_figure) return;
  for (const PointOfBone& each : kPointsOfBody)
    if (sight.figure.has(each.place) && sight.figure.has(each.turn) &&
        !sight.points.has(each.point))
      sight.points.put(each.point, sight.figure.p_WB_m[index_of(each.place)],
                       sight.figure.R_WB[index_of(each.turn)]);
}

}  // namespace dance

#include "testing/xr/state/runtime_poses.h"

#include <numbers>

#include "testing/xr/state/runtime_bindings.h"
#include "testing/xr/state/runtime_paths.h"

namespace dance::test_xr {
namespace {

constexpr XrSpaceLocationFlags kValid =
    XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
constexpr XrSpaceLocationFlags kTracked =
    XR_SPACE_LOCATION_POSITION_TRACKED_BIT | XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT;

// Where a controller points to: its handle leans, the ray leaves its upper end.
Pose grip_to_aim() {
  Pose pose = Pose::Identity();
  pose.translate(Eigen::Vector3d(0.0, 0.02, -0.06));
  pose.rotate(Eigen::AngleAxisd(-std::numbers::pi / 4.0, Eigen::Vector3d::UnitX()));
  return pose;
}

bool is_whole(const PointState& state) {
  return state.p_m.allFinite() && state.R.coeffs().norm() > 0.5;
}

void note_located(const std::string& what) {
  if (runtime().located.insert(what).second) runtime().record.line("located " + what);
}

Located still(const Pose& pose) {
  Located located;
  located.state.p_m = pose.translation();
  located.state.R = Eigen::Quaterniond(pose.linear());
  located.flags = kValid | kTracked;
  return located;
}

Located action_located(const Space& space, XrTime time_ns) {
  const auto source = pose_source(space.session, space.action, space.subaction);
  if (!source) return {};
  const auto point = point_of_top_level(source->top);
  if (!point) return {};
  note_located(std::string(kTrackedPointNames[index_of(*point)]));
  const Located located = point_located(*point, time_ns);
  return source->is_aim ? moved(located, grip_to_aim()) : located;
}

}  // namespace

const char* name_of(SpaceKind kind) {
  constexpr std::array<const char*, 4> kNames{"view", "local", "stage", "action"};
  return kNames[static_cast<std::size_t>(kind)];
}

XrPosef xr_pose(const Pose& pose) {
  const Eigen::Quaternionf q = Eigen::Quaterniond(pose.linear()).normalized().cast<float>();
  const Eigen::Vector3f p = pose.translation().cast<float>();
  return {{q.x(), q.y(), q.z(), q.w()}, {p.x(), p.y(), p.z()}};
}

Pose pose_of(const XrPosef& pose) {
  const XrQuaternionf& q = pose.orientation;
  const Eigen::Quaternionf R(q.w, q.x, q.y, q.z);
  const Eigen::Vector3f p(pose.position.x, pose.position.y, pose.position.z);
  return pose_of(p.cast<double>(), R.cast<double>().normalized());
}

Located point_located(TrackedPoint point, XrTime time_ns) {
  Located located;
  located.state = point_at(runtime().script, point, script_time_s(time_ns));
  if (located.state.tracking != Tracking::kLost) located.flags = kValid;
  if (located.state.tracking == Tracking::kTracked) located.flags |= kTracked;
  return located;
}

Pose origin_at(XrTime time_ns) {
  Pose pose = Pose::Identity();
  for (const Origin& origin : runtime().origins)
    if (origin.since_ns <= time_ns) pose = origin.pose;
  return pose;
}

Located moved(const Located& thing, const Pose& offset) {
  Located result = thing;
  if (!is_whole(thing.state)) return result;
  const Eigen::Vector3d arm = thing.state.R * offset.translation();
  result.state.p_m += arm;
  result.state.R = (thing.state.R * Eigen::Quaterniond(offset.linear())).normalized();
  result.state.v_mps += thing.state.w_radps.cross(arm);
  return result;
}

Located space_located(const Space& space, XrTime time_ns) {
  Located located;
  if (space.kind == SpaceKind::kAction) {
    located = action_located(space, time_ns);
  } else if (space.kind == SpaceKind::kView) {
    note_located("view");
    located = point_located(TrackedPoint::kHead, time_ns);
  } else {
    note_located(name_of(space.kind));
    // LOCAL begins at the height of the head's first keyframe, STAGE on the floor.
    const double height = runtime().script.points[0].keyframes.front().p_m.y();
    Pose pose = origin_at(time_ns);
    if (space.kind == SpaceKind::kLocal) pose.translate(Eigen::Vector3d(0.0, height, 0.0));
    located = still(pose);
  }
  return moved(located, space.offset);
}

XrPosef pose_in(const Located& base, const Located& thing, XrSpaceLocationFlags& flags) {
  flags = 0;
  const bool has_both = (base.flags & kValid) == kValid && (thing.flags & kValid) == kValid;
  if (!has_both) return {{0, 0, 0, 1}, {0, 0, 0}};
  flags = thing.flags & (base.flags | kValid);
  if (is_whole(thing.state) && is_whole(base.state))
    return xr_pose(pose_of(base.state).inverse() * pose_of(thing.state));
  // What the script garbled stays so.
  const PointState& bad = is_whole(base.state) ? thing.state : base.state;
  const Eigen::Vector3f p = bad.p_m.cast<float>();
  const Eigen::Quaternionf q = bad.R.cast<float>();
  return {{q.x(), q.y(), q.z(), q.w()}, {p.x(), p.y(), p.z()}};
}

}  // namespace dance::test_xr

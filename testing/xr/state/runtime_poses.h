// Poses of the test runtime's devices and spaces at a time, and their way into OpenXR's structures.
//
// Units/frames: metres; in the stage as it was at first, T_0X.
// Ownership:    works on runtime().
// Threads:      the caller holds the runtime's lock.
// Failure:      flags say what is valid.
#pragma once

#include "testing/xr/state/runtime_state.h"

namespace dance::test_xr {

// A thing that is located: with scripted NaN and zero quaternions left in.
struct Located {
  PointState state;
  XrSpaceLocationFlags flags = 0;
};

XrPosef xr_pose(const Pose& pose);
Pose pose_of(const XrPosef& pose);
Located point_located(TrackedPoint point, XrTime time_ns);
Pose origin_at(XrTime time_ns);
// Where a space is; an action space through its binding. Notes what the application locates.
Located space_located(const Space& space, XrTime time_ns);
// A located thing in a base space; no flags where either is not valid.
XrPosef pose_in(const Located& base, const Located& thing, XrSpaceLocationFlags& flags);
Located moved(const Located& thing, const Pose& offset);
const char* name_of(SpaceKind kind);

}  // namespace dance::test_xr

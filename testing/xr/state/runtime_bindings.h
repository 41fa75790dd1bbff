// What actions are bound to in a session, and the values they have by it.
//
// Units/frames: none.
// Ownership:    works on runtime().
// Threads:      the caller holds the runtime's lock.
// Failure:      an action that is bound to nothing has no source.
#pragma once

#include "testing/xr/state/runtime_state.h"

namespace dance::test_xr {

struct PoseSource {
  std::string top;
  bool is_aim;
};

// Chooses an interaction profile for each top-level path; after the action sets were attached.
void choose_profiles(Session& session);
// The paths that an action is bound to; XR_NULL_PATH: with any subaction.
std::vector<std::string> sources_of(const Session& session, XrAction action, XrPath subaction);
// Of an action that the last sync made active.
std::optional<PoseSource> pose_source(XrSession session, XrAction action, XrPath subaction);
// What a sync reads, with what it was before.
InputValue read_input(const Session& session, XrAction handle, const Action& action,
                      XrPath subaction);

}  // namespace dance::test_xr

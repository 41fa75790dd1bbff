// What happens to sessions: states, events, and the script's own events when their time comes.
//
// Units/frames: none.
// Ownership:    works on runtime().
// Threads:      the caller holds the runtime's lock.
// Failure:      none.
#pragma once

#include "testing/xr/state/runtime_state.h"

namespace dance::test_xr {

// Carries out what is due, then moves each session towards the state that is wanted of it.
void advance_script();
void change_state(XrSession handle, Session& session, XrSessionState state);
void queue_profile_changed(XrSession handle);

template <class Event>
void queue_event(const Event& event) {
  static_assert(sizeof(Event) <= sizeof(XrEventDataBuffer));
  XrEventDataBuffer buffer{XR_TYPE_EVENT_DATA_BUFFER, nullptr, {}};
  *reinterpret_cast<Event*>(&buffer) = event;
  runtime().events.push_back(buffer);
}

}  // namespace dance::test_xr

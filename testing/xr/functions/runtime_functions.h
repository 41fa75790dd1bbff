// The functions of the OpenXR test runtime by name, a list for each of its parts.
//
// Units/frames: none.
// Ownership:    none.
// Threads:      any.
// Failure:      a name that is not there is not a function of this runtime.
#pragma once

#include <openxr/openxr.h>

#include <map>
#include <string>

namespace dance::test_xr {

struct XrFunction {
  PFN_xrVoidFunction function;
  const char* extension;  // null: of the core
};
using XrFunctionMap = std::map<std::string, XrFunction>;

template <class Function>
void add_function(XrFunctionMap& map, const char* name, Function* function,
                  const char* extension = nullptr) {
  map[name] = {reinterpret_cast<PFN_xrVoidFunction>(function), extension};
}

void add_instance_functions(XrFunctionMap& map);
void add_system_functions(XrFunctionMap& map);
void add_session_functions(XrFunctionMap& map);
void add_space_functions(XrFunctionMap& map);
void add_action_functions(XrFunctionMap& map);
void add_binding_functions(XrFunctionMap& map);
void add_input_functions(XrFunctionMap& map);
void add_haptic_functions(XrFunctionMap& map);
void add_frame_functions(XrFunctionMap& map);
void add_swapchain_functions(XrFunctionMap& map);
void add_view_functions(XrFunctionMap& map);
void add_hand_functions(XrFunctionMap& map);
void add_body_functions(XrFunctionMap& map);
void add_time_functions(XrFunctionMap& map);

}  // namespace dance::test_xr

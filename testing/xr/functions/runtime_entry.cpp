// A runtime of OpenXR for tests. The loader finds it by XR_RUNTIME_JSON=…/dance_test_xr.json; it is
// told what to do by
//   DANCE_XR_SCRIPT=FILE      xr_script.h has the lines of a script
//   DANCE_XR_RECORD=FILE      xr_record.h has the lines of a record; a test wants no `misuse` there
//   DANCE_XR_PICTURES=FOLDER  frame000012-left.ppm, -right.ppm and -quad0.ppm of the frames shown
// all of which are read when an instance is created.
#include "testing/xr/functions/runtime_entry.h"

#include "testing/xr/functions/runtime_functions.h"
#include "testing/xr/state/runtime_call.h"

namespace dance::test_xr {
namespace {

// From openxr_loader_negotiation.h, which Debian's package lacks.
enum LoaderStructure { kLoaderInfo = 1, kRuntimeRequest = 3 };
struct LoaderInfo {
  LoaderStructure structure;
  std::uint32_t version;
  std::size_t size;
  std::uint32_t least_interface;
  std::uint32_t most_interface;
  XrVersion least_api;
  XrVersion most_api;
};
struct RuntimeRequest {
  LoaderStructure structure;
  std::uint32_t version;
  std::size_t size;
  std::uint32_t interface_version;
  XrVersion api;
  PFN_xrGetInstanceProcAddr get_function;
};
constexpr std::uint32_t kInterface = 1;

const XrFunctionMap& functions() {
  static const XrFunctionMap map = [] {
    XrFunctionMap all;
    for (const auto add :
         {add_instance_functions, add_system_functions, add_session_functions, add_space_functions,
          add_action_functions, add_binding_functions, add_input_functions, add_haptic_functions,
          add_frame_functions, add_swapchain_functions, add_view_functions, add_hand_functions,
          add_body_functions, add_time_functions})
      add(all);
    return all;
  }();
  return map;
}

}  // namespace

XrResult XRAPI_CALL get_function(XrInstance instance, const char* name, PFN_xrVoidFunction* into) {
  XrCall call("xrGetInstanceProcAddr");
  if (!name || !into) return call.wrong(XR_ERROR_VALIDATION_FAILURE, "a null pointer");
  *into = nullptr;
  const std::string wanted(name);
  const bool is_of_no_instance = wanted == "xrGetInstanceProcAddr" ||
                                 wanted == "xrCreateInstance" ||
                                 wanted == "xrEnumerateInstanceExtensionProperties";
  if (instance == XR_NULL_HANDLE && !is_of_no_instance) return XR_ERROR_HANDLE_INVALID;
  const auto found = functions().find(wanted);
  if (found == functions().end()) return XR_ERROR_FUNCTION_UNSUPPORTED;
  const char* extension = found->second.extension;
  if (extension && !runtime().extensions.count(extension)) return XR_ERROR_FUNCTION_UNSUPPORTED;
  *into = found->second.function;
  return XR_SUCCESS;
}

}  // namespace dance::test_xr

extern "C" __attribute__((visibility("default"))) XrResult xrNegotiateLoaderRuntimeInterface(
    const void* loader_info, void* runtime_request);

XrResult xrNegotiateLoaderRuntimeInterface(const void* loader_info, void* runtime_request) {
  using namespace dance::test_xr;
  const auto* info = static_cast<const LoaderInfo*>(loader_info);
  auto* request = static_cast<RuntimeRequest*>(runtime_request);
  if (!info || !request || info->structure != kLoaderInfo ||
      request->structure != kRuntimeRequest || info->size != sizeof(LoaderInfo) ||
      request->size != sizeof(RuntimeRequest) || info->least_interface > kInterface ||
      info->most_interface < kInterface)
    return XR_ERROR_INITIALIZATION_FAILED;
  request->interface_version = kInterface;
  request->api = XR_MAKE_VERSION(1, 0, 20);
  request->get_function = get_function;
  return XR_SUCCESS;
}

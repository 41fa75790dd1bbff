// The instance: extensions, the script and the record that the environment names, events, strings.
#include <openxr/openxr_reflection.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "testing/xr/functions/runtime_entry.h"
#include "testing/xr/functions/runtime_functions.h"
#include "testing/xr/state/runtime_call.h"
#include "testing/xr/state/runtime_events.h"
#include "testing/xr/state/runtime_extensions.h"

namespace dance::test_xr {
namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

void start_clock_anew(Runtime& rt, const std::string& key) {
  if (rt.script_path == key) return;
  rt.script_path = key;
  rt.clock_start_ns.reset();
  rt.first_system_ns.reset();
  rt.next_event = 0;
  rt.bad_times.clear();
  rt.failures.clear();
  rt.origins.assign(1, {0, Pose::Identity()});
  rt.is_focus_wanted = rt.is_visible_wanted = true;
  rt.is_stop_wanted = rt.is_exit_wanted = false;
}

// False: the script cannot be read, which is said on stderr and in the record.
bool load_environment() {
  Runtime& rt = runtime();
  rt.pictures_folder = environment("DANCE_XR_PICTURES");
  const std::string path = environment("DANCE_XR_SCRIPT");
  Result<XrScript> script = path.empty() ? default_script() : read_script(path);
  if (!script) {
    rt.record.line("script " + script.error().what);
    std::fprintf(stderr, "%s\n", script.error().what.c_str());
    return false;
  }
  std::ostringstream text;
  if (!path.empty()) text << std::ifstream(path).rdbuf();
  start_clock_anew(rt, path + "\n" + text.str());
  rt.script = *std::move(script);
  return true;
}

XrResult XRAPI_CALL enumerate_extensions(const char*, uint32_t capacity, uint32_t* count,
                                         XrExtensionProperties* properties) {
  XrCall call("xrEnumerateInstanceExtensionProperties");
  if (call.early()) return *call.early();
  if (!runtime().has_instance && !load_environment()) return XR_ERROR_RUNTIME_FAILURE;
  std::vector<XrExtensionProperties> list;
  for (const OfferedExtension& offered : offered_extensions()) {
    XrExtensionProperties property{XR_TYPE_EXTENSION_PROPERTIES, nullptr, {}, offered.version};
    std::strncpy(property.extensionName, offered.name, sizeof property.extensionName - 1);
    list.push_back(property);
  }
  for (std::uint32_t i = 0; properties && i < std::min<std::size_t>(capacity, list.size()); ++i)
    if (!call.is_fine(&properties[i], XR_TYPE_EXTENSION_PROPERTIES)) return call.result();
  return give_list(call, list, capacity, count, properties);
}

void begin_instance(Runtime& rt, const XrInstanceCreateInfo& info) {
  static std::uint64_t instances = 0;
  rt.has_instance = true;
  rt.instance = 0x1000 + 16 * ++instances;
  rt.instance_lost_at_s.reset();
  rt.has_asked_requirements = false;
  rt.is_exit_wanted = false;
  rt.extensions.clear();
  for (std::uint32_t i = 0; i < info.enabledExtensionCount; ++i)
    rt.extensions.insert(info.enabledExtensionNames[i]);
  rt.paths.clear();
  rt.events.clear();
  rt.tracker_paths.clear();
  rt.announced.clear();
  rt.located.clear();
  rt.bindings.clear();
}

XrResult XRAPI_CALL create_instance(const XrInstanceCreateInfo* info, XrInstance* instance) {
  XrCall call("xrCreateInstance");
  Runtime& rt = runtime();
  if (rt.has_instance) return call.wrong(XR_ERROR_LIMIT_REACHED, "an instance is there already");
  rt.record.open(environment("DANCE_XR_RECORD"));
  if (!load_environment()) return XR_ERROR_INITIALIZATION_FAILED;
  if (!call.is_fine(info, XR_TYPE_INSTANCE_CREATE_INFO)) return call.result();
  if (XR_VERSION_MAJOR(info->applicationInfo.apiVersion) != 1)
    return call.wrong(XR_ERROR_API_VERSION_UNSUPPORTED, "the version is not 1.x");
  if (info->applicationInfo.applicationName[0] == '\0')
    return call.wrong(XR_ERROR_NAME_INVALID, "the application has no name");
  for (std::uint32_t i = 0; i < info->enabledExtensionCount; ++i)
    if (!is_offered(info->enabledExtensionNames[i]))
      return call.wrong(XR_ERROR_EXTENSION_NOT_PRESENT, info->enabledExtensionNames[i]);
  begin_instance(rt, *info);
  advance_script();  // what fails at 0
  if (const auto found = rt.failures.find("xrCreateInstance"); found != rt.failures.end()) {
    const XrResult result = found->second;
    rt.failures.erase(found);
    rt.has_instance = false;
    return result;
  }
  *instance = std::bit_cast<XrInstance>(rt.instance);
  return XR_SUCCESS;
}

void note_leaks(XrCall& call, Runtime& rt) {
  const std::pair<const char*, std::size_t> left[] = {{"spaces", rt.spaces.size()},
                                                      {"swapchains", rt.swapchains.size()},
                                                      {"hand trackers", rt.hand_trackers.size()},
                                                      {"body trackers", rt.fb_trackers.size()},
                                                      {"body trackers", rt.bd_trackers.size()},
                                                      {"actions", rt.actions.size()},
                                                      {"action sets", rt.action_sets.size()},
                                                      {"sessions", rt.sessions.size()}};
  for (const auto& [what, count] : left)
    if (count > 0) call.misuse(text_of("%zu %s are left", count, what));
}

XrResult XRAPI_CALL destroy_instance(XrInstance instance) {
  XrCall call("xrDestroyInstance");
  if (!call.has_instance(instance)) return call.result();
  Runtime& rt = runtime();
  note_leaks(call, rt);
  rt.sessions.clear();
  rt.spaces.clear();
  rt.action_sets.clear();
  rt.actions.clear();
  rt.swapchains.clear();
  rt.hand_trackers.clear();
  rt.fb_trackers.clear();
  rt.bd_trackers.clear();
  rt.events.clear();
  rt.has_instance = false;
  rt.record.close();
  return XR_SUCCESS;
}

XrResult XRAPI_CALL instance_properties(XrInstance instance, XrInstanceProperties* properties) {
  XrCall call("xrGetInstanceProperties");
  if (call.early()) return *call.early();
  if (!call.has_instance(instance) || !call.is_fine(properties, XR_TYPE_INSTANCE_PROPERTIES))
    return call.result();
  properties->runtimeVersion = XR_MAKE_VERSION(1, 0, 0);
  std::strcpy(properties->runtimeName, "DanceGraph test runtime");
  return XR_SUCCESS;
}

XrResult XRAPI_CALL poll_event(XrInstance instance, XrEventDataBuffer* event) {
  XrCall call("xrPollEvent");
  if (call.early()) return *call.early();
  if (!call.has_instance(instance) || !call.is_fine(event, XR_TYPE_EVENT_DATA_BUFFER))
    return call.result();
  auto& events = runtime().events;
  if (events.empty()) return XR_EVENT_UNAVAILABLE;
  *event = events.front();
  events.pop_front();
  return XR_SUCCESS;
}

XrResult XRAPI_CALL result_to_string(XrInstance instance, XrResult value,
                                     char text[XR_MAX_RESULT_STRING_SIZE]) {
  XrCall call("xrResultToString");
  if (!call.has_instance(instance)) return call.result();
  const char* name = nullptr;
#define DANCE_XR_NAME(text, number) \
  if (value == number) name = #text;
  XR_LIST_ENUM_XrResult(DANCE_XR_NAME);
  const std::string unknown =
      text_of("XR_UNKNOWN_%s_%d", value < 0 ? "FAILURE" : "SUCCESS", static_cast<int>(value));
  std::snprintf(text, XR_MAX_RESULT_STRING_SIZE, "%s", name ? name : unknown.c_str());
  return XR_SUCCESS;
}

XrResult XRAPI_CALL type_to_string(XrInstance instance, XrStructureType value,
                                   char text[XR_MAX_STRUCTURE_NAME_SIZE]) {
  XrCall call("xrStructureTypeToString");
  if (!call.has_instance(instance)) return call.result();
  const char* name = nullptr;
  XR_LIST_ENUM_XrStructureType(DANCE_XR_NAME);
#undef DANCE_XR_NAME
  const std::string unknown = text_of("XR_UNKNOWN_STRUCTURE_TYPE_%d", static_cast<int>(value));
  std::snprintf(text, XR_MAX_STRUCTURE_NAME_SIZE, "%s", name ? name : unknown.c_str());
  return XR_SUCCESS;
}

}  // namespace

void add_instance_functions(XrFunctionMap& map) {
  add_function(map, "xrGetInstanceProcAddr", get_function);
  add_function(map, "xrEnumerateInstanceExtensionProperties", enumerate_extensions);
  add_function(map, "xrCreateInstance", create_instance);
  add_function(map, "xrDestroyInstance", destroy_instance);
  add_function(map, "xrGetInstanceProperties", instance_properties);
  add_function(map, "xrPollEvent", poll_event);
  add_function(map, "xrResultToString", result_to_string);
  add_function(map, "xrStructureTypeToString", type_to_string);
}

}  // namespace dance::test_xr

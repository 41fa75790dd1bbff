// The headset as a system: whether it is there, what it can, how its views are made.
#include <cstring>

#include "testing/xr/functions/runtime_functions.h"
#include "testing/xr/state/runtime_call.h"

namespace dance::test_xr {
namespace {

XrResult XRAPI_CALL get_system(XrInstance instance, const XrSystemGetInfo* info, XrSystemId* id) {
  XrCall call("xrGetSystem");
  if (call.early()) return *call.early();
  if (!call.has_instance(instance) || !call.is_fine(info, XR_TYPE_SYSTEM_GET_INFO))
    return call.result();
  if (info->formFactor != XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY)
    return XR_ERROR_FORM_FACTOR_UNSUPPORTED;
  Runtime& rt = runtime();
  if (!rt.first_system_ns) rt.first_system_ns = now_ns();
  const double waited_s = static_cast<double>(now_ns() - *rt.first_system_ns) * 1e-9;
  if (waited_s < rt.script.no_system_until_s) return XR_ERROR_FORM_FACTOR_UNAVAILABLE;
  *id = kSystem;
  return XR_SUCCESS;
}

bool is_system(XrCall& call, XrInstance instance, XrSystemId system) {
  if (!call.has_instance(instance)) return false;
  if (system == kSystem) return true;
  call.set_result(call.wrong(XR_ERROR_SYSTEM_INVALID, "not the system of xrGetSystem"));
  return false;
}

bool is_stereo(XrCall& call, XrViewConfigurationType type) {
  if (type == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO) return true;
  call.set_result(call.wrong(XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED, "only stereo is there"));
  return false;
}

XrResult XRAPI_CALL system_properties(XrInstance instance, XrSystemId system,
                                      XrSystemProperties* properties) {
  XrCall call("xrGetSystemProperties");
  if (call.early()) return *call.early();
  if (!is_system(call, instance, system) ||
      !call.is_fine(
          properties, XR_TYPE_SYSTEM_PROPERTIES,
          {XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT, XR_TYPE_SYSTEM_BODY_TRACKING_PROPERTIES_FB,
           XR_TYPE_SYSTEM_PROPERTIES_BODY_TRACKING_FULL_BODY_META,
           XR_TYPE_SYSTEM_BODY_TRACKING_PROPERTIES_BD}))
    return call.result();
  const XrScript& script = runtime().script;
  properties->systemId = kSystem;
  properties->vendorId = 0xDA9CE;
  std::strcpy(properties->systemName, "Test headset");
  properties->graphicsProperties = {8192, 8192, 16};
  properties->trackingProperties = {XR_TRUE, XR_TRUE};
  void* next = properties->next;
  if (auto* hands = find_next<XrSystemHandTrackingPropertiesEXT>(
          next, XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT))
    hands->supportsHandTracking = script.has_hands;
  if (auto* body = find_next<XrSystemBodyTrackingPropertiesFB>(
          next, XR_TYPE_SYSTEM_BODY_TRACKING_PROPERTIES_FB))
    body->supportsBodyTracking = script.has_body;
  if (auto* body = find_next<XrSystemPropertiesBodyTrackingFullBodyMETA>(
          next, XR_TYPE_SYSTEM_PROPERTIES_BODY_TRACKING_FULL_BODY_META))
    body->supportsFullBodyTracking = script.has_body;
  if (auto* body = find_next<XrSystemBodyTrackingPropertiesBD>(
          next, XR_TYPE_SYSTEM_BODY_TRACKING_PROPERTIES_BD))
    body->supportsBodyTracking = script.has_body;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL blend_modes(XrInstance instance, XrSystemId system,
                                XrViewConfigurationType type, uint32_t capacity, uint32_t* count,
                                XrEnvironmentBlendMode* modes) {
  XrCall call("xrEnumerateEnvironmentBlendModes");
  if (call.early()) return *call.early();
  if (!is_system(call, instance, system) || !is_stereo(call, type)) return call.result();
  const std::vector<XrEnvironmentBlendMode> all{XR_ENVIRONMENT_BLEND_MODE_OPAQUE};
  return give_list(call, all, capacity, count, modes);
}

XrResult XRAPI_CALL view_configurations(XrInstance instance, XrSystemId system, uint32_t capacity,
                                        uint32_t* count, XrViewConfigurationType* types) {
  XrCall call("xrEnumerateViewConfigurations");
  if (call.early()) return *call.early();
  if (!is_system(call, instance, system)) return call.result();
  const std::vector<XrViewConfigurationType> all{XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO};
  return give_list(call, all, capacity, count, types);
}

XrResult XRAPI_CALL view_configuration(XrInstance instance, XrSystemId system,
                                       XrViewConfigurationType type,
                                       XrViewConfigurationProperties* properties) {
  XrCall call("xrGetViewConfigurationProperties");
  if (call.early()) return *call.early();
  if (!is_system(call, instance, system) || !is_stereo(call, type) ||
      !call.is_fine(properties, XR_TYPE_VIEW_CONFIGURATION_PROPERTIES))
    return call.result();
  properties->viewConfigurationType = type;
  properties->fovMutable = XR_TRUE;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL configured_views(XrInstance instance, XrSystemId system,
                                     XrViewConfigurationType type, uint32_t capacity,
                                     uint32_t* count, XrViewConfigurationView* views) {
  XrCall call("xrEnumerateViewConfigurationViews");
  if (call.early()) return *call.early();
  if (!is_system(call, instance, system) || !is_stereo(call, type)) return call.result();
  const auto width = static_cast<std::uint32_t>(runtime().script.size_px[0]);
  const auto height = static_cast<std::uint32_t>(runtime().script.size_px[1]);
  const XrViewConfigurationView view{
      XR_TYPE_VIEW_CONFIGURATION_VIEW, nullptr, width, 8192, height, 8192, 1, 4};
  for (std::uint32_t i = 0; views && i < std::min(capacity, 2u); ++i)
    if (!call.is_fine(&views[i], XR_TYPE_VIEW_CONFIGURATION_VIEW)) return call.result();
  return give_list(call, std::vector<XrViewConfigurationView>{view, view}, capacity, count, views);
}

}  // namespace

void add_system_functions(XrFunctionMap& map) {
  add_function(map, "xrGetSystem", get_system);
  add_function(map, "xrGetSystemProperties", system_properties);
  add_function(map, "xrEnumerateEnvironmentBlendModes", blend_modes);
  add_function(map, "xrEnumerateViewConfigurations", view_configurations);
  add_function(map, "xrGetViewConfigurationProperties", view_configuration);
  add_function(map, "xrEnumerateViewConfigurationViews", configured_views);
}

}  // namespace dance::test_xr

#include "producers/xr/xr_runtime.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <ctime>
#define XR_USE_TIMESPEC
#include <openxr/openxr_platform.h>

#include "core/base/printable.h"
#include "formats/openxr/runtime_manifest.h"
#include "producers/xr/openxr_more.h"

namespace dance {
namespace {

constexpr std::array<const char*, 5> kWantedExtensions{
    XR_EXT_HAND_TRACKING_EXTENSION_NAME, XR_HTCX_VIVE_TRACKER_INTERACTION_EXTENSION_NAME,
    XR_FB_BODY_TRACKING_EXTENSION_NAME, XR_META_BODY_TRACKING_FULL_BODY_EXTENSION_NAME,
    XR_BD_BODY_TRACKING_EXTENSION_NAME};
constexpr const char* kOpenGl = "XR_KHR_opengl_enable";

std::string why_no_runtime() {
  const auto manifest = openxr::active_manifest(openxr::own_environment);
  if (!manifest)
    return "no OpenXR runtime can be had: start the headset's own (SteamVR, Monado, WiVRn) and "
           "make "
           "it the active one, or name its manifest in XR_RUNTIME_JSON";
  const auto library = openxr::library_of(*manifest);
  if (!library) return library.error().what;
  return "the OpenXR runtime of " + *manifest + " cannot be loaded (" + *library +
         "): install the headset's runtime again, or make another one active in its settings";
}

Result<std::vector<std::string>> offered_extensions() {
  std::uint32_t count = 0;
  const XrResult asked = xrEnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr);
  if (asked == XR_ERROR_RUNTIME_UNAVAILABLE || asked == XR_ERROR_FILE_ACCESS_ERROR)
    return fail(why_no_runtime());
  if (auto ok = checked(asked, "a list of what it can do"); !ok)
    return tl::make_unexpected(ok.error());
  std::vector<XrExtensionProperties> properties(count,
                                                {XR_TYPE_EXTENSION_PROPERTIES, nullptr, {}, 0});
  if (auto ok =
          checked(xrEnumerateInstanceExtensionProperties(nullptr, count, &count, properties.data()),
                  "a list of what it can do");
      !ok)
    return tl::make_unexpected(ok.error());
  std::vector<std::string> names;
  for (const XrExtensionProperties& each : properties)
    names.emplace_back(each.extensionName, strnlen(each.extensionName, sizeof each.extensionName));
  return names;
}

// As a runtime writes it: it may hold anything.
template <std::size_t kSize>
std::string text_of_array(const char (&text)[kSize]) {
  return printable(std::string_view(text, strnlen(text, kSize)));
}

}  // namespace

Result<std::unique_ptr<XrRuntime>> XrRuntime::open(XrUse use) {
  DANCE_TRY(auto runtime, start(use));
  if (auto found = runtime->find_headset(); !found) return tl::make_unexpected(found.error());
  return runtime;
}

Result<std::unique_ptr<XrRuntime>> XrRuntime::start(XrUse use) {
  std::unique_ptr<XrRuntime> runtime(new XrRuntime(use));
  for (const auto step : {&XrRuntime::create_instance, &XrRuntime::find_clock})
    if (auto done = (runtime.get()->*step)(); !done) return tl::make_unexpected(done.error());
  return runtime;
}

XrRuntime::~XrRuntime() {
  if (instance_ != XR_NULL_HANDLE) xrDestroyInstance(instance_);
}

bool XrRuntime::has(const char* extension) const {
  return std::find(extensions_.begin(), extensions_.end(), extension) != extensions_.end();
}

Result<void> XrRuntime::create_instance() {
  DANCE_TRY(const std::vector<std::string> offered, offered_extensions());
  const auto is_offered = [&](const char* name) {
    return std::find(offered.begin(), offered.end(), name) != offered.end();
  };
  if (!is_offered(XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME))
    return fail(
        "the headset's runtime cannot tell the time of this machine's clock "
        "(XR_KHR_convert_timespec_time): poses would have no moment; use another runtime, such as "
        "SteamVR, Monado or WiVRn");
  if (use_ == XrUse::kTracking && !is_offered(XR_MND_HEADLESS_EXTENSION_NAME))
    return fail(
        "the headset's runtime has no sessions without pictures (XR_MND_headless): leave "
        "--tracking-only out, or use one that has them, such as Monado");
  if (use_ == XrUse::kDisplay && !is_offered(kOpenGl))
    return fail(
        "the headset's runtime takes no pictures of OpenGL (XR_KHR_opengl_enable): use another "
        "runtime, or --tracking-only");
  extensions_ = {XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME,
                 use_ == XrUse::kDisplay ? kOpenGl : XR_MND_HEADLESS_EXTENSION_NAME};
  for (const char* wanted : kWantedExtensions)
    if (is_offered(wanted)) extensions_.emplace_back(wanted);
  // The full body is more joints of the other extension's tracker.
  if (!has(XR_FB_BODY_TRACKING_EXTENSION_NAME))
    std::erase(extensions_, XR_META_BODY_TRACKING_FULL_BODY_EXTENSION_NAME);

  std::vector<const char*> names;
  for (const std::string& name : extensions_) names.push_back(name.c_str());
  XrInstanceCreateInfo info{};
  info.type = XR_TYPE_INSTANCE_CREATE_INFO;
  std::strncpy(info.applicationInfo.applicationName, "DanceGraph",
               XR_MAX_APPLICATION_NAME_SIZE - 1);
  info.applicationInfo.applicationVersion = 1;
  info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
  info.enabledExtensionCount = static_cast<std::uint32_t>(names.size());
  info.enabledExtensionNames = names.data();
  const XrResult made = xrCreateInstance(&info, &instance_);
  if (made == XR_ERROR_RUNTIME_UNAVAILABLE || made == XR_ERROR_RUNTIME_FAILURE)
    return fail("the headset's runtime does not answer (" + name_of(made) + "): is it running?");
  return checked(made, "an instance");
}

Result<void> XrRuntime::find_clock() {
  mono_of_ = function<PFN_xrConvertTimeToTimespecTimeKHR>("xrConvertTimeToTimespecTimeKHR");
  xr_of_ = function<PFN_xrConvertTimespecTimeToTimeKHR>("xrConvertTimespecTimeToTimeKHR");
  if (mono_of_ == nullptr || xr_of_ == nullptr)
    return fail("the headset's runtime promises to tell the time and does not");
  return {};
}

Result<void> XrRuntime::find_headset() {
  XrSystemGetInfo info{};
  info.type = XR_TYPE_SYSTEM_GET_INFO;
  info.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
  const XrResult found = xrGetSystem(instance_, &info, &system_);
  if (found == XR_ERROR_FORM_FACTOR_UNAVAILABLE)
    return fail("the headset is asleep or not connected: put it on, or plug it in");
  is_lost_ = XR_FAILED(found);
  if (is_lost_) return checked(found, "a headset");
  look_at_system();
  return {};
}

void XrRuntime::look_at_system() {
  XrSystemHandTrackingPropertiesEXT hands{};
  hands.type = XR_TYPE_SYSTEM_HAND_TRACKING_PROPERTIES_EXT;
  XrSystemBodyTrackingPropertiesFB body{};
  body.type = XR_TYPE_SYSTEM_BODY_TRACKING_PROPERTIES_FB;
  XrSystemPropertiesBodyTrackingFullBodyMETA legs{};
  legs.type = XR_TYPE_SYSTEM_PROPERTIES_BODY_TRACKING_FULL_BODY_META;
  XrSystemBodyTrackingPropertiesBD body_bd{};
  body_bd.type = XR_TYPE_SYSTEM_BODY_TRACKING_PROPERTIES_BD;
  XrSystemProperties properties{};
  properties.type = XR_TYPE_SYSTEM_PROPERTIES;
  const auto ask = [&](const char* extension, auto& more) {
    if (!has(extension)) return;
    more.next = properties.next;
    properties.next = &more;
  };
  ask(XR_EXT_HAND_TRACKING_EXTENSION_NAME, hands);
  ask(XR_FB_BODY_TRACKING_EXTENSION_NAME, body);
  ask(XR_META_BODY_TRACKING_FULL_BODY_EXTENSION_NAME, legs);
  ask(XR_BD_BODY_TRACKING_EXTENSION_NAME, body_bd);
  std::string headset = "a headset";
  if (XR_SUCCEEDED(xrGetSystemProperties(instance_, system_, &properties)))
    headset = text_of_array(properties.systemName);
  sees_hands_ = hands.supportsHandTracking == XR_TRUE;
  sees_body_fb_ = body.supportsBodyTracking == XR_TRUE;
  sees_legs_fb_ = sees_body_fb_ && legs.supportsFullBodyTracking == XR_TRUE;
  sees_body_bd_ = body_bd.supportsBodyTracking == XR_TRUE;
  XrInstanceProperties runtime{};
  runtime.type = XR_TYPE_INSTANCE_PROPERTIES;
  if (XR_SUCCEEDED(xrGetInstanceProperties(instance_, &runtime)))
    headset += " by " + text_of_array(runtime.runtimeName);
  name_ = headset;
}

MonoTime XrRuntime::mono_of(XrTime time) const {
  struct timespec spec {};
  if (time <= 0 || XR_FAILED(mono_of_(instance_, time, &spec))) return {};
  return MonoTime::from_ns(std::int64_t{spec.tv_sec} * 1'000'000'000 + spec.tv_nsec);
}

XrTime XrRuntime::xr_of(MonoTime time) const {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  struct timespec spec {};
  spec.tv_sec = static_cast<time_t>(time.since_zero_ns() / kSecond_ns);
  spec.tv_nsec = static_cast<long>(time.since_zero_ns() % kSecond_ns);
  XrTime converted = 0;
  if (XR_FAILED(xr_of_(instance_, &spec, &converted))) return 0;
  return converted;
}

}  // namespace dance

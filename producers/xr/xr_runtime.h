// XrRuntime: the OpenXR runtime of this machine and the headset behind it: which extensions it has,
// and what its time is in this house's clock.
//
// Units/frames: XrTime counts in the runtime's clock; MonoTime is this process's.
// Ownership:    owns the OpenXR instance; sessions must be gone before it.
// Threads:      const calls on any; one opens and destroys.
// Failure:      open() says in one line what is missing (no runtime, headset asleep, no clock of
//               ours, no headless sessions) and the cure.
// Source:       OpenXR 1.0; XR_KHR_convert_timespec_time, whose clock is CLOCK_MONOTONIC.
#pragma once

#include <openxr/openxr.h>

#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"
#include "producers/xr/xr_result.h"

namespace dance {

// What the runtime is used for.
enum class XrUse { kTracking, kDisplay };

class XrRuntime {
 public:
  // The runtime and the headset behind it.
  static Result<std::unique_ptr<XrRuntime>> open(XrUse use);
  // The runtime alone: some cannot be left and entered again and again while a headset sleeps.
  static Result<std::unique_ptr<XrRuntime>> start(XrUse use);
  // An error while the headset is asleep or unplugged, to be tried again unless the runtime itself
  // is lost.
  Result<void> find_headset();
  bool is_lost() const { return is_lost_; }
  ~XrRuntime();
  XrRuntime(const XrRuntime&) = delete;
  XrRuntime& operator=(const XrRuntime&) = delete;

  XrUse use() const { return use_; }
  XrInstance instance() const { return instance_; }
  XrSystemId system() const { return system_; }
  // Of the runtime and of the headset, as they may be printed.
  const std::string& name() const { return name_; }
  // Whether it was offered and is switched on.
  bool has(const char* extension) const;
  // Whether the headset sees bare hands, and bodies by each of the extensions.
  bool sees_hands() const { return sees_hands_; }
  bool sees_body_fb() const { return sees_body_fb_; }
  bool sees_legs_fb() const { return sees_legs_fb_; }
  bool sees_body_bd() const { return sees_body_bd_; }

  // MonoTime() and 0 where the runtime refuses: it has lost its clock, or the time is none.
  MonoTime mono_of(XrTime time) const;
  XrTime xr_of(MonoTime time) const;

  // A function of an extension; null where the runtime lacks it.
  template <class Function>
  Function function(const char* name) const {
    PFN_xrVoidFunction found = nullptr;
    if (XR_FAILED(xrGetInstanceProcAddr(instance_, name, &found))) return nullptr;
    return reinterpret_cast<Function>(found);
  }

 private:
  explicit XrRuntime(XrUse use) : use_(use) {}
  Result<void> create_instance();
  Result<void> find_clock();
  void look_at_system();

  XrUse use_;
  XrInstance instance_ = XR_NULL_HANDLE;
  XrSystemId system_ = XR_NULL_SYSTEM_ID;
  std::string name_;
  std::vector<std::string> extensions_;
  bool is_lost_ = false;
  bool sees_hands_ = false, sees_body_fb_ = false, sees_legs_fb_ = false, sees_body_bd_ = false;
  XrResult (*mono_of_)(XrInstance, XrTime, struct timespec*) = nullptr;
  XrResult (*xr_of_)(XrInstance, const struct timespec*, XrTime*) = nullptr;
};

}  // namespace dance

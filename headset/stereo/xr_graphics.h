// XrGraphics: what OpenXR wants to know of the OpenGL context that is current, which must be a
// window's of X11.
//
// Units/frames: none.
// Ownership:    borrows the context, which must outlive sessions that are made with it.
// Threads:      the one whose context is current.
// Failure:      of_current() names what driver or display lack.
// Source:       XR_KHR_opengl_enable.
#pragma once

#include <memory>

#include "producers/xr/xr_runtime.h"

namespace dance {

class XrGraphics {
 public:
  static Result<std::unique_ptr<XrGraphics>> of_current(const XrRuntime& runtime);
  virtual ~XrGraphics() = default;
  // For XrDancerSession::create(); good as long as this.
  virtual const void* binding() const = 0;
};

}  // namespace dance

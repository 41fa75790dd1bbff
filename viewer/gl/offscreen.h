// OffscreenContext: an OpenGL 3.3 core context that needs neither a display nor a window system,
// for pictures in files.
//
// Units/frames: sizes in pixels.
// Ownership:    owns its EGL display and context; makes itself current when made.
// Threads:      the one that made it.
// Failure:      create() names what is missing and the package that brings it.
// Source:       EGL_MESA_platform_surfaceless.
#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"

namespace dance {

class OffscreenContext {
 public:
  static Result<std::unique_ptr<OffscreenContext>> create();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

 private:
  OffscreenContext() = default;
  void* display_ = nullptr;
  void* context_ = nullptr;
};

// The renderer of the current context, as the driver names it; "" without a context.
std::string renderer_name();
// True when pixels are made by the processor alone (such as llvmpipe) in the current context.
bool is_software_rendering();

}  // namespace dance

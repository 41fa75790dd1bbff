#include "viewer/gl/offscreen.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

namespace dance {
namespace {
constexpr const char* kCure = "; install one with: apt-get install libegl1 libgl1-mesa-dri";
}  // namespace

Result<std::unique_ptr<OffscreenContext>> OffscreenContext::create() {
  std::unique_ptr<OffscreenContext> self(new OffscreenContext);
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    return fail(std::string("no EGL driver here draws without a display") + kCure);
  EGLDisplay display =
      eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr))
    return fail(std::string("EGL cannot be started without a display") + kCure);
  self->display_ = display;
  const EGLint config_wants[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                 EGL_NONE};
  EGLConfig config = nullptr;
  EGLint found = 0;
  const EGLint context_wants[] = {EGL_CONTEXT_MAJOR_VERSION,
                                  3,
                                  EGL_CONTEXT_MINOR_VERSION,
                                  3,
                                  EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                  EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                  EGL_NONE};
  if (!eglBindAPI(EGL_OPENGL_API) || !eglChooseConfig(display, config_wants, &config, 1, &found) ||
      found < 1)
    return fail(std::string("EGL offers no OpenGL here") + kCure);
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, context_wants);
  if (context == EGL_NO_CONTEXT) return fail(std::string("EGL offers no OpenGL 3.3 here") + kCure);
  self->context_ = context;
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
    return fail(std::string("EGL cannot draw without a surface here") + kCure);
  return self;
}

OffscreenContext::~OffscreenContext() {
  if (display_ == nullptr) return;
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (context_ != nullptr) eglDestroyContext(display_, context_);
  eglTerminate(display_);
}

std::string renderer_name() {
  const auto* text = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return text != nullptr ? text : "";
}

bool is_software_rendering() {
  const std::string renderer = renderer_name();
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SwiftShader"})
    if (renderer.find(name) != std::string::npos) return true;
  return false;
}

}  // namespace dance

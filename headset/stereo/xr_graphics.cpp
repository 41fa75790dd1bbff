#include "headset/stereo/xr_graphics.h"

#include <epoxy/gl.h>
#include <epoxy/glx.h>
#define XR_USE_PLATFORM_XLIB
#define XR_USE_GRAPHICS_API_OPENGL
#include <openxr/openxr_platform.h>

namespace dance {
namespace {

class XlibGraphics final : public XrGraphics {
 public:
  XrGraphicsBindingOpenGLXlibKHR xlib{};
  const void* binding() const override { return &xlib; }
};

Result<void> check_version(const XrRuntime& runtime) {
  const auto ask = runtime.function<PFN_xrGetOpenGLGraphicsRequirementsKHR>(
      "xrGetOpenGLGraphicsRequirementsKHR");
  XrGraphicsRequirementsOpenGLKHR wanted{};
  wanted.type = XR_TYPE_GRAPHICS_REQUIREMENTS_OPENGL_KHR;
  if (ask == nullptr) return fail("the headset's runtime promises to take OpenGL and does not");
  if (auto told = checked(ask(runtime.instance(), runtime.system(), &wanted),
                          "to say which OpenGL it takes");
      !told)
    return told;
  const int version = epoxy_gl_version();
  const auto least = static_cast<int>(10 * XR_VERSION_MAJOR(wanted.minApiVersionSupported) +
                                      XR_VERSION_MINOR(wanted.minApiVersionSupported));
  if (version < least)
    return fail("the headset's runtime wants OpenGL " + std::to_string(least / 10) + "." +
                std::to_string(least % 10) + ", and this driver gave " +
                std::to_string(version / 10) + "." + std::to_string(version % 10) +
                "; update the graphics driver");
  return {};
}

}  // namespace

Result<std::unique_ptr<XrGraphics>> XrGraphics::of_current(const XrRuntime& runtime) {
  if (auto able = check_version(runtime); !able) return tl::make_unexpected(able.error());
  auto graphics = std::make_unique<XlibGraphics>();
  graphics->xlib.type = XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR;
  graphics->xlib.xDisplay = glXGetCurrentDisplay();
  graphics->xlib.glxContext = glXGetCurrentContext();
  graphics->xlib.glxDrawable = glXGetCurrentDrawable();
  if (graphics->xlib.xDisplay == nullptr || graphics->xlib.glxContext == nullptr)
    return fail(
        "the window is not one of X11 with GLX, which the headset's runtime needs; start it with "
        "an X11 or XWayland display");
  Display* display = graphics->xlib.xDisplay;
  int id = 0;
  glXQueryContext(display, graphics->xlib.glxContext, GLX_FBCONFIG_ID, &id);
  const int attributes[] = {GLX_FBCONFIG_ID, id, 0};
  int count = 0;
  GLXFBConfig* configs = glXChooseFBConfig(display, DefaultScreen(display), attributes, &count);
  if (configs != nullptr && count > 0) {
    graphics->xlib.glxFBConfig = configs[0];
    int visual = 0;
    glXGetFBConfigAttrib(display, configs[0], GLX_VISUAL_ID, &visual);
    graphics->xlib.visualid = static_cast<std::uint32_t>(visual);
  }
  if (configs != nullptr) XFree(configs);
  return graphics;
}

}  // namespace dance

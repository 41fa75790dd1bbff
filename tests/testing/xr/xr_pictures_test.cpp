// Frames that a client draws with OpenGL, and the pictures that the test runtime makes of them.
#include <epoxy/gl.h>
#include <epoxy/glx.h>
#include <gtest/gtest.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#define XR_USE_GRAPHICS_API_OPENGL
#define XR_USE_PLATFORM_XLIB
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>

#include "testing/scratch_folder.h"
#include "tests/virtual_display.h"
#include "tests/xr_loader_leaks.h"

namespace dance {
namespace {

constexpr XrPosef kIdentity{{0, 0, 0, 1}, {0, 0, 0}};

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// One headset with two swapchains; draws a colour a frame.
struct Client {
  XrInstance instance = XR_NULL_HANDLE;
  XrSystemId system = XR_NULL_SYSTEM_ID;
  XrSession session = XR_NULL_HANDLE;
  XrSpace stage = XR_NULL_HANDLE;
  std::array<XrSwapchain, 2> swapchains{};
  std::array<std::array<XrSwapchainImageOpenGLKHR, 3>, 2> images{};

  XrResult create_instance() {
    XrInstanceCreateInfo info{};
    info.type = XR_TYPE_INSTANCE_CREATE_INFO;
    std::strcpy(info.applicationInfo.applicationName, "test");
    info.applicationInfo.apiVersion = XR_CURRENT_API_VERSION;
    const char* extension = "XR_KHR_opengl_enable";
    info.enabledExtensionCount = 1;
    info.enabledExtensionNames = &extension;
    if (const XrResult made = xrCreateInstance(&info, &instance); made != XR_SUCCESS) return made;
    const XrSystemGetInfo get{XR_TYPE_SYSTEM_GET_INFO, nullptr,
                              XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY};
    return xrGetSystem(instance, &get, &system);
  }
  void ask_requirements() const {
    PFN_xrGetOpenGLGraphicsRequirementsKHR ask = nullptr;
    xrGetInstanceProcAddr(instance, "xrGetOpenGLGraphicsRequirementsKHR",
                          reinterpret_cast<PFN_xrVoidFunction*>(&ask));
    XrGraphicsRequirementsOpenGLKHR needs{XR_TYPE_GRAPHICS_REQUIREMENTS_OPENGL_KHR, nullptr, 0, 0};
    EXPECT_EQ(ask(instance, system, &needs), XR_SUCCESS);
  }
  XrResult create_session() {
    const XrGraphicsBindingOpenGLXlibKHR binding{XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR,
                                                 nullptr,
                                                 glXGetCurrentDisplay(),
                                                 0,
                                                 nullptr,
                                                 glXGetCurrentDrawable(),
                                                 glXGetCurrentContext()};
    const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, &binding, 0, system};
    return xrCreateSession(instance, &info, &session);
  }
  void begin() {
    const XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO, nullptr,
                                  XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO};
    ASSERT_EQ(xrBeginSession(session, &info), XR_SUCCESS);
    const XrReferenceSpaceCreateInfo space{XR_TYPE_REFERENCE_SPACE_CREATE_INFO, nullptr,
                                           XR_REFERENCE_SPACE_TYPE_STAGE, kIdentity};
    ASSERT_EQ(xrCreateReferenceSpace(session, &space, &stage), XR_SUCCESS);
    for (std::size_t eye = 0; eye < 2; ++eye) {
      const XrSwapchainCreateInfo info_of_eye{XR_TYPE_SWAPCHAIN_CREATE_INFO,
                                              nullptr,
                                              0,
                                              XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT,
                                              GL_SRGB8_ALPHA8,
                                              1,
                                              8,
                                              4,
                                              1,
                                              1,
                                              1};
      ASSERT_EQ(xrCreateSwapchain(session, &info_of_eye, &swapchains[eye]), XR_SUCCESS);
      images[eye].fill({XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR, nullptr, 0});
      std::uint32_t count = 0;
      ASSERT_EQ(xrEnumerateSwapchainImages(
                    swapchains[eye], 3, &count,
                    reinterpret_cast<XrSwapchainImageBaseHeader*>(images[eye].data())),
                XR_SUCCESS);
    }
  }
  // The upper half in this colour, the lower black.
  void draw(std::size_t eye, std::array<float, 3> colour, bool is_released = true) const {
    std::uint32_t index = 0;
    ASSERT_EQ(xrAcquireSwapchainImage(swapchains[eye], nullptr, &index), XR_SUCCESS);
    const XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr,
                                        XR_INFINITE_DURATION};
    ASSERT_EQ(xrWaitSwapchainImage(swapchains[eye], &wait), XR_SUCCESS);
    GLuint target = 0;
    glGenFramebuffers(1, &target);
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                           images[eye][index].image, 0);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 2, 8, 2);
    glClearColor(colour[0], colour[1], colour[2], 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
    glDeleteFramebuffers(1, &target);
    if (!is_released) return;
    ASSERT_EQ(xrReleaseSwapchainImage(swapchains[eye], nullptr), XR_SUCCESS);
  }
  XrFrameState begin_frame() const {
    XrFrameState state{XR_TYPE_FRAME_STATE, nullptr, 0, 0, 0};
    EXPECT_EQ(xrWaitFrame(session, nullptr, &state), XR_SUCCESS);
    EXPECT_EQ(xrBeginFrame(session, nullptr), XR_SUCCESS);
    return state;
  }
  void end_frame(XrTime time, bool has_layers) const {
    std::array<XrCompositionLayerProjectionView, 2> views{};
    for (std::size_t eye = 0; eye < 2; ++eye)
      views[eye] = {XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW,
                    nullptr,
                    kIdentity,
                    {-0.8f, 0.7f, 0.8f, -0.8f},
                    {swapchains[eye], {{0, 0}, {8, 4}}, 0}};
    const XrCompositionLayerProjection projection{
        XR_TYPE_COMPOSITION_LAYER_PROJECTION, nullptr, 0, stage, 2, views.data()};
    const XrCompositionLayerQuad quad{
        XR_TYPE_COMPOSITION_LAYER_QUAD,       nullptr,   0,           stage, XR_EYE_VISIBILITY_BOTH,
        {swapchains[0], {{0, 0}, {4, 4}}, 0}, kIdentity, {1.0f, 0.5f}};
    const std::array<const XrCompositionLayerBaseHeader*, 2> layers{
        reinterpret_cast<const XrCompositionLayerBaseHeader*>(&projection),
        reinterpret_cast<const XrCompositionLayerBaseHeader*>(&quad)};
    const XrFrameEndInfo end{XR_TYPE_FRAME_END_INFO,
                             nullptr,
                             time,
                             XR_ENVIRONMENT_BLEND_MODE_OPAQUE,
                             has_layers ? 2u : 0u,
                             has_layers ? layers.data() : nullptr};
    EXPECT_EQ(xrEndFrame(session, &end), XR_SUCCESS);
  }
};

TEST(XrPictures, ShowWhatAClientDraws) {
  const VirtualDisplay screen;
  if (screen.display().empty()) GTEST_SKIP() << kNoVirtualDisplay;
  setenv("DISPLAY", screen.display().c_str(), 1);
  const auto folder = ScratchFolder::make();
  ASSERT_TRUE(folder.has_value());
  setenv("XR_RUNTIME_JSON", DANCE_BINARY_DIR "/lib/dance_test_xr.json", 1);
  setenv("DANCE_XR_RECORD", (*folder)->file("record").c_str(), 1);
  setenv("DANCE_XR_PICTURES", (*folder)->file("").c_str(), 1);
  unsetenv("DANCE_XR_SCRIPT");
  ASSERT_TRUE(glfwInit());
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  GLFWwindow* window = glfwCreateWindow(64, 64, "test", nullptr, nullptr);
  if (!window) GTEST_SKIP() << "no OpenGL here";
  glfwMakeContextCurrent(window);

  Client client;
  ASSERT_EQ(client.create_instance(), XR_SUCCESS);
  EXPECT_EQ(client.create_session(), XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING);
  client.ask_requirements();
  ASSERT_EQ(client.create_session(), XR_SUCCESS);
  client.begin();
  const XrFrameState first = client.begin_frame();
  EXPECT_FALSE(first.shouldRender);
  client.end_frame(first.predictedDisplayTime, false);
  const XrFrameState second = client.begin_frame();
  EXPECT_TRUE(second.shouldRender);
  client.draw(0, {1, 0, 0});
  client.draw(1, {0, 0, 1});
  client.end_frame(second.predictedDisplayTime, true);
  const auto count_misuse = [&] {
    std::istringstream lines(read_file((*folder)->file("record")));
    int count = 0;
    for (std::string line; std::getline(lines, line);) count += line.starts_with("misuse");
    return count;
  };
  EXPECT_EQ(count_misuse(), 1) << read_file((*folder)->file("record"));
  const XrFrameState third = client.begin_frame();
  client.draw(0, {0, 1, 0}, false);
  client.end_frame(third.predictedDisplayTime + 1, true);
  EXPECT_EQ(count_misuse(), 3) << "an image that was not released, a time never predicted";
  const std::string left = read_file((*folder)->file("frame000001-left.ppm"));
  ASSERT_TRUE(left.starts_with("P6\n8 4\n255\n")) << left.size();
  EXPECT_EQ(left.substr(11, 3), std::string("\xFF\0\0", 3)) << "the first row is the upper one";
  EXPECT_EQ(left.substr(left.size() - 3), std::string(3, '\0'));
  EXPECT_EQ(read_file((*folder)->file("frame000001-right.ppm")).substr(11, 3),
            std::string("\0\0\xFF", 3));
  EXPECT_TRUE(
      read_file((*folder)->file("frame000001-quad0.ppm")).starts_with("P6\n4 4\n255\n\xFF"));
  xrDestroySession(client.session);
  xrDestroyInstance(client.instance);
  // No glfwTerminate(): the driver that it unloads keeps memory, which would count as ours.
}

}  // namespace
}  // namespace dance

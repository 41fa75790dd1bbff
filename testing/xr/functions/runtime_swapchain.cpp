// Swapchains: three OpenGL textures each, acquired, waited for and released in turn.

#include <algorithm>

#include "testing/xr/functions/runtime_functions.h"
#include "testing/xr/functions/runtime_gl.h"
#include "testing/xr/functions/xr_platform.h"
#include "testing/xr/state/runtime_call.h"

namespace dance::test_xr {
namespace {

constexpr std::uint32_t kImages = 3;
// GL_SRGB8_ALPHA8, GL_RGBA8, GL_RGBA16F, the best first.
constexpr std::array<std::int64_t, 3> kFormats{0x8C43, 0x8058, 0x881A};

XrResult XRAPI_CALL swapchain_formats(XrSession handle, uint32_t capacity, uint32_t* count,
                                      int64_t* formats) {
  XrCall call("xrEnumerateSwapchainFormats");
  if (call.early()) return *call.early();
  const Session* session = call.session(handle);
  if (!session) return call.result();
  if (session->is_headless)
    return give_list(call, std::vector<std::int64_t>(), capacity, count, formats);
  return give_list(call, kFormats, capacity, count, formats);
}

XrResult XRAPI_CALL create_swapchain(XrSession handle, const XrSwapchainCreateInfo* info,
                                     XrSwapchain* swapchain) {
  XrCall call("xrCreateSwapchain");
  if (call.early()) return *call.early();
  const Session* session = call.session(handle);
  if (!session || !call.is_fine(info, XR_TYPE_SWAPCHAIN_CREATE_INFO)) return call.result();
  if (std::find(kFormats.begin(), kFormats.end(), info->format) == kFormats.end() ||
      session->is_headless)
    return call.wrong(XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED, "a format that is not enumerated");
  if (info->sampleCount != 1 || info->faceCount != 1 || info->mipCount != 1)
    return call.wrong(XR_ERROR_FEATURE_UNSUPPORTED, "samples, faces and mip levels are one each");
  const auto is_fine_size = [](std::uint32_t n) { return n > 0 && n <= 8192; };
  if (!is_fine_size(info->width) || !is_fine_size(info->height) || info->arraySize < 1 ||
      info->arraySize > 2)
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "a size that is not possible");
  if (!is_context_current(session->gl_context))
    return call.wrong(XR_ERROR_RUNTIME_FAILURE, "the session's OpenGL context is not current");
  auto made = std::make_unique<Swapchain>();
  made->session = handle;
  made->info = *info;
  made->info.next = nullptr;
  made->textures = make_textures(*info, kImages);
  *swapchain = runtime().swapchains.add(std::move(made));
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroy_swapchain(XrSwapchain handle) {
  XrCall call("xrDestroySwapchain");
  const Swapchain* swapchain = runtime().swapchains.find(handle);
  if (!swapchain) return call.wrong(XR_ERROR_HANDLE_INVALID, "the swapchain is not alive");
  delete_textures(swapchain->textures);
  runtime().swapchains.remove(handle);
  return XR_SUCCESS;
}

// Null where it is not alive, or its session is lost.
Swapchain* find_swapchain(XrCall& call, XrSwapchain handle) {
  Swapchain* swapchain = runtime().swapchains.find(handle);
  if (!swapchain)
    call.set_result(call.wrong(XR_ERROR_HANDLE_INVALID, "the swapchain is not alive"));
  return swapchain && call.session(swapchain->session) ? swapchain : nullptr;
}

XrResult XRAPI_CALL swapchain_images(XrSwapchain handle, uint32_t capacity, uint32_t* count,
                                     XrSwapchainImageBaseHeader* images) {
  XrCall call("xrEnumerateSwapchainImages");
  if (call.early()) return *call.early();
  const Swapchain* swapchain = find_swapchain(call, handle);
  if (!swapchain) return call.result();
  auto* gl_images = reinterpret_cast<XrSwapchainImageOpenGLKHR*>(images);
  for (std::uint32_t i = 0; gl_images && i < std::min(capacity, kImages); ++i)
    if (!call.is_fine(&gl_images[i], XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR)) return call.result();
  std::vector<XrSwapchainImageOpenGLKHR> found;
  for (const std::uint32_t texture : swapchain->textures)
    found.push_back({XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR, nullptr, texture});
  return give_list(call, found, capacity, count, gl_images);
}

XrResult XRAPI_CALL acquire_image(XrSwapchain handle, const XrSwapchainImageAcquireInfo* info,
                                  uint32_t* index) {
  XrCall call("xrAcquireSwapchainImage");
  if (call.early()) return *call.early();
  Swapchain* swapchain = find_swapchain(call, handle);
  if (!swapchain || (info && !call.is_fine(info, XR_TYPE_SWAPCHAIN_IMAGE_ACQUIRE_INFO)))
    return call.result();
  if (!index) return call.wrong(XR_ERROR_VALIDATION_FAILURE, "no place for the index");
  if (swapchain->acquired.size() == kImages)
    return call.wrong(XR_ERROR_CALL_ORDER_INVALID, "all images are acquired already");
  *index = swapchain->next;
  swapchain->acquired.push_back(swapchain->next);
  swapchain->next = (swapchain->next + 1) % kImages;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL wait_image(XrSwapchain handle, const XrSwapchainImageWaitInfo* info) {
  XrCall call("xrWaitSwapchainImage");
  if (call.early()) return *call.early();
  Swapchain* swapchain = find_swapchain(call, handle);
  if (!swapchain || !call.is_fine(info, XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO)) return call.result();
  if (swapchain->acquired.empty() || swapchain->is_waited)
    return call.wrong(XR_ERROR_CALL_ORDER_INVALID, "no image was acquired, or it was waited for");
  swapchain->is_waited = true;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL release_image(XrSwapchain handle, const XrSwapchainImageReleaseInfo* info) {
  XrCall call("xrReleaseSwapchainImage");
  if (call.early()) return *call.early();
  Swapchain* swapchain = find_swapchain(call, handle);
  if (!swapchain || (info && !call.is_fine(info, XR_TYPE_SWAPCHAIN_IMAGE_RELEASE_INFO)))
    return call.result();
  if (!swapchain->is_waited)
    return call.wrong(XR_ERROR_CALL_ORDER_INVALID, "no image was waited for");
  swapchain->released = static_cast<int>(swapchain->acquired.front());
  swapchain->acquired.pop_front();
  swapchain->is_waited = false;
  return XR_SUCCESS;
}

}  // namespace

void add_swapchain_functions(XrFunctionMap& map) {
  add_function(map, "xrEnumerateSwapchainFormats", swapchain_formats);
  add_function(map, "xrCreateSwapchain", create_swapchain);
  add_function(map, "xrDestroySwapchain", destroy_swapchain);
  add_function(map, "xrEnumerateSwapchainImages", swapchain_images);
  add_function(map, "xrAcquireSwapchainImage", acquire_image);
  add_function(map, "xrWaitSwapchainImage", wait_image);
  add_function(map, "xrReleaseSwapchainImage", release_image);
}

}  // namespace dance::test_xr

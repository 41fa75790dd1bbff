#include "headset/stereo/xr_frames.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
// The structures of OpenGL's images are behind a platform's headers, which this file does without.
#define XR_USE_GRAPHICS_API_OPENGL
#include <openxr/openxr_platform.h>

namespace dance {
namespace {

constexpr float kLeastScale = 0.25f, kMostScale = 2.0f;
constexpr XrDuration kLongestWait_ns = 200'000'000;
constexpr int kMostWaits = 10;
constexpr int kMostRefused = 50;
constexpr std::chrono::milliseconds kAfterRefusal(10);
// A picture is seen within these of its beginning, else the time is none.
constexpr Duration kSoonest = -Duration::ms(50), kLatest = Duration::ms(400);
constexpr Duration kLongPast = -Duration::ms(500);  // no machine is so late
constexpr auto kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;

}  // namespace

Result<std::unique_ptr<XrFrames>> XrFrames::create(XrDancerSession& session, float scale) {
  std::unique_ptr<XrFrames> frames(new XrFrames(session));
  if (auto opened = frames->open(scale); !opened) return tl::make_unexpected(opened.error());
  return frames;
}

XrFrames::~XrFrames() {
  for (const Chain& chain : chains_)
    if (chain.handle != XR_NULL_HANDLE) xrDestroySwapchain(chain.handle);
}

Result<void> XrFrames::open(float scale) {
  const XrRuntime& runtime = session_.runtime();
  std::array<XrViewConfigurationView, kXrEyes> views{};
  for (auto& view : views) view.type = XR_TYPE_VIEW_CONFIGURATION_VIEW;
  std::uint32_t count = 0;
  if (auto told =
          checked(xrEnumerateViewConfigurationViews(runtime.instance(), runtime.system(), kStereo,
                                                    views.size(), &count, views.data()),
                  "pictures for two eyes");
      !told)
    return told;
  if (count != kXrEyes) return fail("the headset has not two eyes");
  const float clamped = std::clamp(scale, kLeastScale, kMostScale);
  const auto size_of = [&](std::uint32_t recommended, std::uint32_t most) {
    const auto wanted = std::lround(clamped * static_cast<float>(recommended));
    return static_cast<int>(std::clamp(wanted, 16l, static_cast<long>(std::max(most, 16u))));
  };
  width_px_ = size_of(views[0].recommendedImageRectWidth, views[0].maxImageRectWidth);
  height_px_ = size_of(views[0].recommendedImageRectHeight, views[0].maxImageRectHeight);
  blend_ = choose_blend();
  DANCE_TRY(const std::int64_t format, choose_format());
  for (Chain& chain : chains_)
    if (auto made = make_chain(chain, format); !made) return made;
  return {};
}

// The stage covers all that is seen, where the headset can.
XrEnvironmentBlendMode XrFrames::choose_blend() const {
  const XrRuntime& runtime = session_.runtime();
  std::array<XrEnvironmentBlendMode, 8> modes{};
  std::uint32_t count = 0;
  const XrResult told = xrEnumerateEnvironmentBlendModes(
      runtime.instance(), runtime.system(), kStereo, static_cast<std::uint32_t>(modes.size()),
      &count, modes.data());
  if (XR_FAILED(told) || count == 0) return XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
  const auto end = modes.begin() + count;
  const bool has_opaque = std::find(modes.begin(), end, XR_ENVIRONMENT_BLEND_MODE_OPAQUE) != end;
  return has_opaque ? XR_ENVIRONMENT_BLEND_MODE_OPAQUE : modes[0];
}

Result<std::int64_t> XrFrames::choose_format() const {
  std::uint32_t count = 0;
  std::vector<std::int64_t> formats;
  if (XR_SUCCEEDED(xrEnumerateSwapchainFormats(session_.handle(), 0, &count, nullptr))) {
    formats.resize(count);
    if (XR_FAILED(xrEnumerateSwapchainFormats(session_.handle(), count, &count, formats.data())))
      formats.clear();
  }
  // The finished picture is as a screen shows it: the runtime must take it so.
  for (const std::int64_t wanted : {std::int64_t{GL_SRGB8_ALPHA8}, std::int64_t{GL_SRGB8}})
    if (std::find(formats.begin(), formats.end(), wanted) != formats.end()) return wanted;
  return fail("the headset's runtime takes no 8-bit sRGB pictures of OpenGL; use another runtime");
}

Result<void> XrFrames::make_chain(Chain& chain, std::int64_t format) const {
  XrSwapchainCreateInfo info{};
  info.type = XR_TYPE_SWAPCHAIN_CREATE_INFO;
  info.usageFlags = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
  info.format = format;
  info.sampleCount = 1;
  info.width = static_cast<std::uint32_t>(width_px_);
  info.height = static_cast<std::uint32_t>(height_px_);
  info.faceCount = info.arraySize = info.mipCount = 1;
  if (auto made = checked(xrCreateSwapchain(session_.handle(), &info, &chain.handle),
                          "images for the eyes");
      !made)
    return made;
  std::uint32_t count = 0;
  if (auto told = checked(xrEnumerateSwapchainImages(chain.handle, 0, &count, nullptr),
                          "images for the eyes");
      !told)
    return told;
  std::vector<XrSwapchainImageOpenGLKHR> images(count);
  for (auto& image : images) image.type = XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR;
  if (auto told = checked(
          xrEnumerateSwapchainImages(chain.handle, count, &count,
                                     reinterpret_cast<XrSwapchainImageBaseHeader*>(images.data())),
          "images for the eyes");
      !told)
    return told;
  for (const auto& image : images) chain.textures.push_back(image.image);
  return {};
}

bool XrFrames::take(XrResult result, const char* call) {
  session_.note(result);
  if (XR_SUCCEEDED(result)) return true;
  ++refused_in_a_row_;
  refusal_ = result;
  refused_call_ = call;
  // A runtime that refuses at once would keep a core busy.
  std::this_thread::sleep_for(kAfterRefusal);
  return false;
}

Result<void> XrFrames::health() const {
  if (refused_in_a_row_ < kMostRefused) return {};
  return fail(std::string("the headset's runtime takes no pictures (") + refused_call_ + ": " +
              name_of(refusal_) + ")");
}

XrFrames::Turn XrFrames::begin(const std::function<MonoTime()>& now) {
  Turn turn;
  XrFrameState state{};
  state.type = XR_TYPE_FRAME_STATE;
  XrFrameWaitInfo wait{};
  wait.type = XR_TYPE_FRAME_WAIT_INFO;
  const XrResult waited = xrWaitFrame(session_.handle(), &wait, &state);
  if (!take(waited, "xrWaitFrame")) return turn;
  XrFrameBeginInfo begin{};
  begin.type = XR_TYPE_FRAME_BEGIN_INFO;
  const XrResult begun = xrBeginFrame(session_.handle(), &begin);
  if (!take(begun, "xrBeginFrame")) return turn;
  turn.is_begun = true;
  turn.is_to_draw = state.shouldRender == XR_TRUE;
  turn.display_time = state.predictedDisplayTime;
  if (state.predictedDisplayPeriod > 1'000'000 && state.predictedDisplayPeriod < 100'000'000)
    period_ = Duration::ns(state.predictedDisplayPeriod);
  const MonoTime present = now();
  turn.seen_at = session_.runtime().mono_of(turn.display_time);
  const Duration until = turn.seen_at - present;
  const bool is_past = turn.seen_at.is_set() && until < kSoonest;
  const bool is_none = !turn.seen_at.is_set() || until > kLatest;
  turn.promised = turn.display_time;
  if (is_past || is_none) {
    turn.seen_at = present + period_;
    turn.display_time = session_.runtime().xr_of(turn.seen_at);
  }
  // Of a picture that is late, as on a busy machine, the runtime wants to hear its own time.
  if (is_none) turn.promised = turn.display_time;
  if (is_none || (is_past && until < kLongPast)) ++bad_times_;
  return turn;
}

bool XrFrames::locate(const Turn& turn, std::array<XrEye, kXrEyes>& eyes) {
  XrViewLocateInfo info{};
  info.type = XR_TYPE_VIEW_LOCATE_INFO;
  info.viewConfigurationType = kStereo;
  info.displayTime = turn.display_time;
  info.space = session_.base();
  XrViewState state{};
  state.type = XR_TYPE_VIEW_STATE;
  std::array<XrView, kXrEyes> views{};
  for (auto& view : views) view.type = XR_TYPE_VIEW;
  std::uint32_t count = 0;
  const XrResult located =
      xrLocateViews(session_.handle(), &info, &state, kXrEyes, &count, views.data());
  session_.note(located);
  if (XR_FAILED(located) || count != kXrEyes) return false;
  for (std::size_t i = 0; i < kXrEyes; ++i) {
    // The flags of views have the same bits.
    const auto place = place_of(state.viewStateFlags, views[i].pose, false);
    const XrFovf& fov = views[i].fov;
    const bool is_open = fov.angleRight - fov.angleLeft > 0.1f &&
                         fov.angleUp - fov.angleDown > 0.1f && std::abs(fov.angleLeft) < 1.5f &&
                         std::abs(fov.angleRight) < 1.5f && std::abs(fov.angleUp) < 1.5f &&
                         std::abs(fov.angleDown) < 1.5f;
    if (!place || !is_open) return false;
    eyes[i] = {*place, fov, views[i].pose};
  }
  return true;
}

unsigned XrFrames::acquire(std::size_t eye) {
  const Chain& chain = chains_[eye];
  std::uint32_t index = 0;
  const XrResult acquired = xrAcquireSwapchainImage(chain.handle, nullptr, &index);
  session_.note(acquired);
  if (XR_FAILED(acquired)) return 0;
  XrSwapchainImageWaitInfo wait{};
  wait.type = XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO;
  wait.timeout = kLongestWait_ns;
  XrResult waited = XR_TIMEOUT_EXPIRED;
  for (int i = 0; i < kMostWaits && waited == XR_TIMEOUT_EXPIRED; ++i)
    waited = xrWaitSwapchainImage(chain.handle, &wait);
  // An image that never comes back can neither be drawn nor released.
  session_.note(waited == XR_TIMEOUT_EXPIRED ? XR_ERROR_SESSION_LOST : waited);
  if (waited != XR_SUCCESS) return 0;
  if (index < chain.textures.size()) return chain.textures[index];
  release(eye);
  return 0;
}

void XrFrames::release(std::size_t eye) {
  session_.note(xrReleaseSwapchainImage(chains_[eye].handle, nullptr));
}

void XrFrames::end(const Turn& turn, const std::array<XrEye, kXrEyes>* eyes) {
  if (!turn.is_begun) return;
  std::array<XrCompositionLayerProjectionView, kXrEyes> views{};
  XrCompositionLayerProjection projection{};
  projection.type = XR_TYPE_COMPOSITION_LAYER_PROJECTION;
  projection.space = session_.base();
  projection.viewCount = kXrEyes;
  projection.views = views.data();
  const auto* layer = reinterpret_cast<const XrCompositionLayerBaseHeader*>(&projection);
  XrFrameEndInfo info{};
  info.type = XR_TYPE_FRAME_END_INFO;
  info.displayTime = turn.promised;
  info.environmentBlendMode = blend_;
  if (eyes != nullptr) {
    for (std::size_t i = 0; i < kXrEyes; ++i) {
      views[i].type = XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW;
      views[i].pose = (*eyes)[i].as_told;
      views[i].fov = (*eyes)[i].fov;
      views[i].subImage.swapchain = chains_[i].handle;
      views[i].subImage.imageRect = {{0, 0}, {width_px_, height_px_}};
    }
    info.layerCount = 1;
    info.layers = &layer;
  }
  if (!take(xrEndFrame(session_.handle(), &info), "xrEndFrame")) return;
  refused_in_a_row_ = 0;
  if (eyes != nullptr) ++pictures_;
}

}  // namespace dance

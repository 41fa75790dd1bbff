#include "testing/xr/functions/runtime_layers.h"

#include <cmath>

#include "testing/xr/functions/runtime_gl.h"
#include "testing/xr/state/runtime_poses.h"

namespace dance::test_xr {
namespace {

XrResult check_part(XrCall& call, const XrSwapchainSubImage& part) {
  const Swapchain* swapchain = runtime().swapchains.find(part.swapchain);
  if (!swapchain) return call.wrong(XR_ERROR_HANDLE_INVALID, "a layer's swapchain is not alive");
  if (swapchain->released < 0)
    return call.wrong(XR_ERROR_LAYER_INVALID, "no image of a layer's swapchain was released yet");
  const XrRect2Di& rect = part.imageRect;
  const bool is_inside =
      rect.offset.x >= 0 && rect.offset.y >= 0 && rect.extent.width > 0 && rect.extent.height > 0 &&
      static_cast<std::uint32_t>(rect.offset.x + rect.extent.width) <= swapchain->info.width &&
      static_cast<std::uint32_t>(rect.offset.y + rect.extent.height) <= swapchain->info.height;
  if (!is_inside)
    return call.wrong(XR_ERROR_SWAPCHAIN_RECT_INVALID, "a rectangle outside its swapchain");
  if (part.imageArrayIndex >= swapchain->info.arraySize)
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "an imageArrayIndex outside its swapchain");
  return XR_SUCCESS;
}

bool is_fine_fov(const XrFovf& fov) {
  const auto is_angle = [](float x) { return std::abs(x) < 1.5707f; };  // false for NaN
  return is_angle(fov.angleLeft) && is_angle(fov.angleRight) && is_angle(fov.angleUp) &&
         is_angle(fov.angleDown) && fov.angleLeft < fov.angleRight && fov.angleDown < fov.angleUp;
}

XrResult check_projection(XrCall& call, const XrCompositionLayerProjection& layer) {
  if (!call.is_fine(&layer, XR_TYPE_COMPOSITION_LAYER_PROJECTION)) return call.result();
  if (layer.viewCount != 2 || !layer.views)
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "a projection without its two views");
  for (std::uint32_t eye = 0; eye < 2; ++eye) {
    const XrCompositionLayerProjectionView& view = layer.views[eye];
    if (!call.is_fine(&view, XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW) ||
        !call.is_fine_pose(view.pose, "the pose of a view"))
      return call.result();
    if (!is_fine_fov(view.fov))
      return call.wrong(XR_ERROR_VALIDATION_FAILURE, "a field of view that is none");
    if (const XrResult result = check_part(call, view.subImage); result != XR_SUCCESS)
      return result;
  }
  return XR_SUCCESS;
}

XrResult check_quad(XrCall& call, const XrCompositionLayerQuad& layer) {
  if (!call.is_fine(&layer, XR_TYPE_COMPOSITION_LAYER_QUAD) ||
      !call.is_fine_pose(layer.pose, "the pose of a quad"))
    return call.result();
  if (!(layer.size.width > 0.0f && layer.size.height > 0.0f))
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "a quad without a size");
  return check_part(call, layer.subImage);
}

XrResult check_layer(XrCall& call, const XrCompositionLayerBaseHeader* layer) {
  if (!layer) return call.wrong(XR_ERROR_LAYER_INVALID, "a layer that is null");
  if (!runtime().spaces.find(layer->space))
    return call.wrong(XR_ERROR_HANDLE_INVALID, "the space of a layer is not alive");
  if (layer->type == XR_TYPE_COMPOSITION_LAYER_PROJECTION)
    return check_projection(call, *reinterpret_cast<const XrCompositionLayerProjection*>(layer));
  if (layer->type == XR_TYPE_COMPOSITION_LAYER_QUAD)
    return check_quad(call, *reinterpret_cast<const XrCompositionLayerQuad*>(layer));
  return call.wrong(XR_ERROR_LAYER_INVALID,
                    text_of("a layer of type %d", static_cast<int>(layer->type)));
}

std::string text_of_pose(const XrPosef& pose) {
  const XrVector3f& p = pose.position;
  const XrQuaternionf& q = pose.orientation;
  return text_of("%.5f %.5f %.5f %.6f %.6f %.6f %.6f", static_cast<double>(p.x),
                 static_cast<double>(p.y), static_cast<double>(p.z), static_cast<double>(q.x),
                 static_cast<double>(q.y), static_cast<double>(q.z), static_cast<double>(q.w));
}

// Makes the pictures of a frame, or does nothing.
class Pictures {
 public:
  Pictures(XrCall& call, const Session& session) : call_(call) {
    const Runtime& rt = runtime();
    is_wanted_ = !rt.pictures_folder.empty() && session.frames % rt.script.pictures_every == 0;
    if (is_wanted_ && !is_context_current(session.gl_context)) {
      is_wanted_ = false;
      call.misuse("the session's OpenGL context is not current");
    }
    start_ = rt.pictures_folder + text_of("/frame%06lld-", static_cast<long long>(session.frames));
  }
  void take(const XrSwapchainSubImage& part, const std::string& name) const {
    if (!is_wanted_) return;
    const Swapchain& swapchain = *runtime().swapchains.find(part.swapchain);
    const std::uint32_t texture = swapchain.textures[static_cast<std::size_t>(swapchain.released)];
    if (!write_picture(texture, swapchain.info, part, start_ + name + ".ppm"))
      call_.misuse("no picture can be made: " + start_ + name + ".ppm");
  }

 private:
  XrCall& call_;
  bool is_wanted_ = false;
  std::string start_;
};

void record_projection(const XrCompositionLayerProjection& layer, const Pictures& pictures) {
  const char* space = name_of(runtime().spaces.find(layer.space)->kind);
  for (std::uint32_t eye = 0; eye < 2; ++eye) {
    const XrCompositionLayerProjectionView& view = layer.views[eye];
    const char* name = eye == 0 ? "left" : "right";
    const std::string fov =
        text_of("%.6f %.6f %.6f %.6f", static_cast<double>(view.fov.angleLeft),
                static_cast<double>(view.fov.angleRight), static_cast<double>(view.fov.angleUp),
                static_cast<double>(view.fov.angleDown));
    runtime().record.line(std::string("view ") + name + " " + text_of_pose(view.pose) + " " + fov +
                          " " + space);
    pictures.take(view.subImage, name);
  }
}

}  // namespace

XrResult check_layers(XrCall& call, const Session& session, const XrFrameEndInfo& info) {
  if (info.environmentBlendMode != XR_ENVIRONMENT_BLEND_MODE_OPAQUE)
    return call.wrong(XR_ERROR_ENVIRONMENT_BLEND_MODE_UNSUPPORTED, "only opaque is there");
  if (info.layerCount > 16) return call.wrong(XR_ERROR_LAYER_LIMIT_EXCEEDED, "too many layers");
  if (info.layerCount > 0 && (!info.layers || session.is_headless))
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "layers that cannot be");
  for (std::uint32_t i = 0; i < info.layerCount; ++i)
    if (const XrResult result = check_layer(call, info.layers[i]); result != XR_SUCCESS)
      return result;
  for (const auto& [number, swapchain] : runtime().swapchains)
    if (!swapchain->acquired.empty()) call.misuse("an acquired image was not released");
  return XR_SUCCESS;
}

void record_frame(XrCall& call, const Session& session, const XrFrameEndInfo& info) {
  runtime().record.line(text_of("frame %lld %lld layers %u", static_cast<long long>(session.frames),
                                static_cast<long long>(info.displayTime), info.layerCount));
  const Pictures pictures(call, session);
  int quads = 0;
  for (std::uint32_t i = 0; i < info.layerCount; ++i) {
    if (info.layers[i]->type == XR_TYPE_COMPOSITION_LAYER_PROJECTION) {
      record_projection(*reinterpret_cast<const XrCompositionLayerProjection*>(info.layers[i]),
                        pictures);
      continue;
    }
    const auto& quad = *reinterpret_cast<const XrCompositionLayerQuad*>(info.layers[i]);
    runtime().record.line("quad " + text_of_pose(quad.pose) +
                          text_of(" %.4f %.4f %s", static_cast<double>(quad.size.width),
                                  static_cast<double>(quad.size.height),
                                  name_of(runtime().spaces.find(quad.space)->kind)));
    pictures.take(quad.subImage, "quad" + std::to_string(quads++));
  }
}

}  // namespace dance::test_xr

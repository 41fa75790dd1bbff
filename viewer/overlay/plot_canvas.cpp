#include "viewer/overlay/plot_canvas.h"

#include <imgui.h>

#include <cmath>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/offscreen.h"
#include "viewer/gl/picture_target.h"
#include "viewer/overlay/imgui_on_gl.h"
#include "viewer/overlay/overlay_fonts.h"

namespace dance {
namespace {

constexpr float kPlotText_px = 15.0f;
constexpr float kPlotTitle_px = 18.0f;

ImU32 plot_colour(std::uint32_t rgb) {
  return IM_COL32((rgb >> 16) & 0xff, (rgb >> 8) & 0xff, rgb & 0xff, 255);
}
ImVec2 vec(PlotPoint p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }

class GlPlotCanvas final : public PlotCanvas {
 public:
  GlPlotCanvas(std::unique_ptr<OffscreenContext> context, int width_px, int height_px)
      : context_(std::move(context)), width_px_(width_px), height_px_(height_px) {}

  Result<void> begin() {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    text_ = add_overlay_font(atlas, kPlotText_px);
    title_ = add_overlay_font(atlas, kPlotTitle_px);
    if (auto begun = imgui_.begin("a plot"); !begun) return begun;
    if (auto sized = target_.resize(width_px_, height_px_); !sized) return sized;
    imgui_.begin_frame(width_px_, height_px_);
    list_ = ImGui::GetBackgroundDrawList();
    return {};
  }

  void line(PlotPoint from, PlotPoint to, std::uint32_t colour, double width) override {
    list_->AddLine(vec(from), vec(to), plot_colour(colour), static_cast<float>(width));
  }
  void curve(const std::vector<PlotPoint>& points, std::uint32_t colour, double width) override {
    std::vector<ImVec2> path;
    for (const PlotPoint& p : points) path.push_back(vec(p));
    list_->AddPolyline(path.data(), static_cast<int>(path.size()), plot_colour(colour), 0,
                       static_cast<float>(width));
  }
  void box(PlotPoint low, PlotPoint high, std::uint32_t colour) override {
    list_->AddRectFilled(vec(low), vec(high), plot_colour(colour));
  }
  void text(PlotPoint at, const std::string& words, std::uint32_t colour, Anchor anchor,
            Size size) override {
    const double width = width_of(words, size);
    const double x = anchor == Anchor::kLeft     ? at.x
                     : anchor == Anchor::kMiddle ? at.x - 0.5 * width
                                                 : at.x - width;
    const ImFont* font = font_of(size);
    const double y = at.y - 0.5 * static_cast<double>(font->FontSize);
    list_->AddText(font, font->FontSize, vec({std::round(x), std::round(y)}), plot_colour(colour),
                   words.c_str());
  }
  double width_of(const std::string& words, Size size) const override {
    const ImFont* font = font_of(size);
    return static_cast<double>(font->CalcTextSizeA(font->FontSize, 1e5f, 0.0f, words.c_str()).x);
  }
  void clip(PlotPoint low, PlotPoint high) override {
    list_->PushClipRect(vec(low), vec(high), true);
  }
  void end_clip() override { list_->PopClipRect(); }

  Result<Picture> finish() override {
    target_.bind_finished();
    glClearColor(1.0f, 1.0f, 1.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    imgui_.end_frame();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_.finished().name());
    return read_bound_framebuffer(width_px_, height_px_);
  }

 private:
  ImFont* font_of(Size size) const { return size == Size::kTitle ? title_ : text_; }

  std::unique_ptr<OffscreenContext> context_;
  ImguiOnGl imgui_;
  int width_px_, height_px_;
  PictureTarget target_{0};
  ImDrawList* list_ = nullptr;
  ImFont* text_ = nullptr;
  ImFont* title_ = nullptr;
};

}  // namespace

Result<std::unique_ptr<PlotCanvas>> PlotCanvas::create(int width_px, int height_px) {
  DANCE_TRY(auto context, OffscreenContext::create());
  auto canvas = std::make_unique<GlPlotCanvas>(std::move(context), width_px, height_px);
  if (auto begun = canvas->begin(); !begun) return tl::make_unexpected(begun.error());
  return canvas;
}

}  // namespace dance

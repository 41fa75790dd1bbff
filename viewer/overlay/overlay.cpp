#include "viewer/overlay/overlay.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "formats/body/guest_look.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/overlay/beat_panel.h"
#include "viewer/overlay/dance_sign.h"
#include "viewer/overlay/overlay_fonts.h"
#include "viewer/overlay/voice_mark.h"
#include "viewer/panel/panel_stack.h"
#include "viewer/words/shown_name.h"

namespace dance {

using Eigen::Vector3f;

namespace {

constexpr float kTagFont_px = 17.0f;
constexpr float kHudFont_px = 14.0f;
constexpr float kDigitFont_px = 110.0f;
constexpr float kHudWidth_em = 25.1f;  // as draw_hud() makes it
constexpr float kPanelLines = 7.4f;    // of the smaller font
ImU32 colour_of(const Vector3f& linear, float alpha) {
  const Vector3f s = srgb_from_linear(linear);
  return ImGui::ColorConvertFloat4ToU32(ImVec4(s.x(), s.y(), s.z(), alpha));
}
ImU32 white(float alpha) { return ImGui::ColorConvertFloat4ToU32(ImVec4(1, 1, 1, alpha)); }
ImU32 shade(float alpha) {
  return ImGui::ColorConvertFloat4ToU32(ImVec4(0.04f, 0.045f, 0.07f, alpha));
}
// Text on whole pixels is sharp.
ImVec2 on_pixel(float x, float y) { return {std::round(x), std::round(y)}; }

// The sign of recording, as on cameras: a red dot in a ring. Radius in heights of letters.
constexpr float kRecordMark = 0.36f;
void draw_record_mark(ImDrawList& list, ImVec2 centre, float radius_px, float alpha) {
  const auto red = ImGui::ColorConvertFloat4ToU32(ImVec4(0.95f, 0.24f, 0.21f, alpha));
  list.AddCircleFilled(centre, 0.62f * radius_px, red, 20);
  list.AddCircle(centre, radius_px, red, 24, 0.16f * radius_px + 1.0f);
}

struct Tag {
  const SceneGuest* guest;
  ScreenPoint at;
};

// More name tags than these overlap wherever they are placed.
constexpr std::size_t kTagsKeptApart = 4;
// A guest who is drawn more transparently leaves the place to the other names.
constexpr float kPushesAside = 0.5f;

// A couple, one in front of the other: the tag of the farther one goes above the nearer one's. Tags
// from far to near.
void keep_apart(std::vector<Tag>& tags, float width_px, float height_px) {
  if (tags.size() > kTagsKeptApart) return;
  for (std::size_t far = tags.size(); far-- > 0;)
    for (std::size_t near = far + 1; near < tags.size(); ++near) {
      ScreenPoint& at = tags[far].at;
      const ScreenPoint& other = tags[near].at;
      if (tags[near].guest->opacity < kPushesAside) continue;
      if (std::abs(at.x_px - other.x_px) < width_px && std::abs(at.y_px - other.y_px) < height_px)
        at.y_px = other.y_px - height_px;
    }
}

}  // namespace

Result<std::unique_ptr<Overlay>> Overlay::create(float scale) {
  std::unique_ptr<Overlay> overlay(new Overlay(scale));
  overlay->make_fonts();
  if (auto begun = overlay->imgui_.begin("text"); !begun) return tl::make_unexpected(begun.error());
  return overlay;
}

void Overlay::make_fonts() {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  tag_font_ = add_overlay_font(atlas, kTagFont_px * scale_);
  hud_font_ = add_overlay_font(atlas, kHudFont_px * scale_);
  digit_font_ = add_digit_font(atlas, kDigitFont_px * scale_);
  if (find_overlay_font() != nullptr) return;
  font_note_ =
      "no DejaVu font here, text is coarse; install it with: apt-get install fonts-dejavu-core";
}

void Overlay::set_scale(float scale) {
  if (std::abs(scale - scale_) < 0.01f) return;
  scale_ = scale;
  make_fonts();
  imgui_.renew_fonts();
}

void Overlay::draw(const SceneState& scene, const OrbitCamera& camera, int width_px, int height_px,
                   const OverlayChoice& choice) {
  const auto width = static_cast<float>(width_px);
  const auto height = static_cast<float>(height_px);
  imgui_.begin_frame(width_px, height_px);
  if (choice.tags) draw_tags(scene, camera, choice.tag_anchors_W_m, width, height);
  draw_signs(*ImGui::GetBackgroundDrawList(),
             {scene, camera, choice.tag_anchors_W_m, width, height, tag_font_->FontSize});
  if (choice.hud) draw_hud(scene);
  draw_words(choice, width, height);
  PanelFrame frame = frame_of(scene, width, height);
  if (choice.hud && !scene.guests.empty()) frame.figures_px = kHudWidth_em * hud_font_->FontSize;
  draw_notes(scene, height - (choice.panels != nullptr ? choice.panels->bottom_px(frame) : 0.0f));
  if (choice.panels != nullptr) choice.panels->draw(frame);
  imgui_.end_frame();
}

int Overlay::panel_height_px(int height_px) const {
  return std::min(static_cast<int>(std::lround(kPanelLines * hud_font_->FontSize)), height_px / 3);
}

void Overlay::draw_beats(const Comparison& comparison, int width_px, int height_px,
                         PanelStack* panels) {
  imgui_.begin_frame(width_px, height_px);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto middle = static_cast<float>(width_px / 2);
  const auto bottom = static_cast<float>(height_px);
  const auto top = static_cast<float>(height_px - panel_height_px(height_px));
  const PanelFonts fonts{tag_font_, hud_font_};
  draw_beat_panel(list, fonts, comparison.raw, {0.0f, top, middle, bottom}, "as it comes");
  draw_beat_panel(list, fonts, comparison.shown,
                  {middle, top, static_cast<float>(width_px), bottom},
                  comparison.is_of_twins ? "in rhythm" : "as it is staged");
  list.AddRectFilled({middle - 1.0f, 0.0f}, {middle + 1.0f, bottom}, shade(1.0f));
  if (panels != nullptr)  // above the beats
    panels->draw(frame_of(comparison.shown, static_cast<float>(width_px), top));
  imgui_.end_frame();
}

void Overlay::draw_frames(std::span<const StageCell> cells, int width_px, int height_px,
                          const OverlayChoice& choice) {
  imgui_.begin_frame(width_px, height_px);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float line = std::max(1.0f, std::round(2.0f * scale_));
  for (const StageCell& cell : cells) {
    if (!cell.is_chosen) continue;
    const auto left = static_cast<float>(cell.box.left_px);
    const auto top = static_cast<float>(cell.box.top_px);
    list.AddRect({left + 0.5f * line, top + 0.5f * line},
                 {left + static_cast<float>(cell.box.width_px) - 0.5f * line,
                  top + static_cast<float>(cell.box.height_px) - 0.5f * line},
                 white(0.85f), 0.0f, 0, line);
  }
  const auto width = static_cast<float>(width_px);
  const auto height = static_cast<float>(height_px);
  if (choice.whole != nullptr) {
    const PanelFrame frame = frame_of(*choice.whole, width, height);
    draw_notes(*choice.whole,
               height - (choice.panels != nullptr ? choice.panels->bottom_px(frame) : 0.0f));
    if (choice.panels != nullptr) choice.panels->draw(frame);
  }
  imgui_.end_frame();
}

PanelFrame Overlay::frame_of(const SceneState& scene, float width_px, float height_px) const {
  return {scene, width_px, height_px, scale_, tag_font_, hud_font_, digit_font_, texts_.language()};
}

// In dark rounds, as the tags are.
void Overlay::draw_words(const OverlayChoice& choice, float width_px, float height_px) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float size = tag_font_->FontSize;
  const auto put = [&](const std::string& words, float x, float y) {
    const float width = tag_font_->CalcTextSizeA(size, 1e4f, 0.0f, words.c_str()).x;
    x = std::max(0.5f * size, x - 0.5f * width);
    list.AddRectFilled(on_pixel(x - 0.4f * size, y - 0.2f * size),
                       on_pixel(x + width + 0.4f * size, y + 1.25f * size), shade(0.72f),
                       0.6f * size);
    list.AddText(tag_font_, size, on_pixel(x, y), white(0.94f), words.c_str());
  };
  if (!choice.title.empty() && !choice.hud) put(choice.title, 0.0f, 0.5f * size);
  if (!choice.caption.empty()) put(choice.caption, 0.5f * width_px, height_px - 1.7f * size);
}

void Overlay::draw_tags(const SceneState& scene, const OrbitCamera& camera,
                        std::span<const Vector3f> anchors_W_m, float width_px, float height_px) {
  std::vector<Tag> tags;
  for (std::size_t i = 0; i < scene.guests.size(); ++i) {
    const SceneGuest& guest = scene.guests[i];
    const Vector3f anchor_W_m = i < anchors_W_m.size() ? anchors_W_m[i] : tag_anchor_W_m(guest);
    if (guest.hides_head) continue;  // over one's own eyes there is none
    if (const auto at = project(camera, anchor_W_m, width_px, height_px))
      tags.push_back({&guest, *at});
  }
  // Near over far.
  std::sort(tags.begin(), tags.end(),
            [](const Tag& a, const Tag& b) { return a.at.depth_m > b.at.depth_m; });
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float size = tag_font_->FontSize;
  const float pad = 0.42f * size;
  keep_apart(tags, 3.6f * size, 1.6f * size);
  for (const Tag& tag : tags) {
    const std::string_view shown = shown_name(scene.names, tag.guest->id, texts_);
    const char* name = shown.data();  // ends with a zero
    const float alpha = tag.guest->opacity;
    const ImVec2 text = tag_font_->CalcTextSizeA(size, width_px, 0.0f, name);
    const float dot = 0.26f * size;
    const bool has_mark = tag.guest->voice_mark != VoiceMark::kNone;
    const float mark = has_mark ? 0.8f * size : 0.0f;
    const float mark_room = has_mark ? mark + pad : 0.0f;
    const float record_room = tag.guest->is_recording ? 2.0f * kRecordMark * size + pad : 0.0f;
    const float half = 0.5f * (text.x + 3.0f * dot + mark_room + record_room) + pad;
    const ImVec2 low = on_pixel(tag.at.x_px - half, tag.at.y_px - text.y - 0.5f * pad);
    const ImVec2 high = on_pixel(tag.at.x_px + half, tag.at.y_px + 0.5f * pad);
    const float radius = 0.5f * (high.y - low.y);
    list.AddRectFilled(low, high, shade(0.66f * alpha), radius);
    const ImVec2 centre(low.x + pad + dot, 0.5f * (low.y + high.y));
    const Vector3f colour = look_of(tag.guest->id).tag;
    list.AddCircleFilled(centre, dot, colour_of(colour, alpha), 16);
    // Who speaks: a bar below the name, as long as the voice is loud.
    if (tag.guest->voice > 0.0f)
      list.AddRectFilled({low.x + radius, high.y - 0.5f * pad},
                         {low.x + radius + tag.guest->voice * (high.x - low.x - 2.0f * radius),
                          high.y - 0.1f * pad},
                         colour_of(colour, alpha));
    list.AddText(tag_font_, size, on_pixel(centre.x + 2.0f * dot, low.y + 0.5f * pad),
                 white(0.94f * alpha), name);
    draw_voice_mark(list, tag.guest->voice_mark,
                    {high.x - record_room - pad - 0.5f * mark, 0.5f * (low.y + high.y)}, mark,
                    alpha);
    if (tag.guest->is_recording)
      draw_record_mark(list, {high.x - pad - kRecordMark * size, 0.5f * (low.y + high.y)},
                       kRecordMark * size, alpha);
  }
}

void Overlay::draw_hud(const SceneState& scene) {
  if (scene.guests.empty()) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float size = hud_font_->FontSize;
  const float line = 1.35f * size;
  const float margin = size;
  constexpr std::array<const char*, 4> kHeads{"", "rate", "age", "loss"};
  const std::array<float, 4> right_edge{10.0f * size, 14.5f * size, 19.0f * size, 23.5f * size};
  const auto rows = static_cast<float>(scene.guests.size() + 1);
  list.AddRectFilled({0.6f * margin, 0.6f * margin},
                     {margin + right_edge[3] + 0.6f * margin, 1.4f * margin + rows * line},
                     shade(0.5f), 0.5f * size);
  const auto text_right = [&](float edge, float y, ImU32 colour, const char* text) {
    const float width = hud_font_->CalcTextSizeA(size, 1e4f, 0.0f, text).x;
    list.AddText(hud_font_, size, on_pixel(margin + edge - width, y), colour, text);
  };
  float y = margin;
  for (std::size_t i = 1; i < kHeads.size(); ++i)
    text_right(right_edge[i], y, white(0.55f), kHeads[i]);
  std::array<char, 48> text{};
  for (const SceneGuest& guest : scene.guests) {
    y += line;
    const float alpha = 0.4f + 0.55f * guest.opacity;
    list.AddCircleFilled({margin + 0.4f * size, y + 0.55f * size}, 0.28f * size,
                         colour_of(look_of(guest.id).tag, alpha), 16);
    list.AddText(hud_font_, size, on_pixel(margin + size, y), white(alpha), guest.id.c_str());
    const auto put = [&](float edge, const char* format, float value) {
      std::snprintf(text.data(), text.size(), format, static_cast<double>(value));
      text_right(edge, y, white(alpha), text.data());
    };
    put(right_edge[1], "%.0f Hz", guest.figures.arrival_hz);
    if (guest.figures.age_ms) put(right_edge[2], "%.1f ms", *guest.figures.age_ms);
    if (guest.figures.loss_percent) put(right_edge[3], "%.1f %%", *guest.figures.loss_percent);
  }
}

void Overlay::draw_notes(const SceneState& scene, float height_px) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float size = hud_font_->FontSize;
  float y = height_px - size - 1.35f * size * static_cast<float>(scene.notes.size());
  for (const std::string& note : scene.notes) {
    list.AddText(hud_font_, size, on_pixel(size, y), white(0.7f), note.c_str());
    y += 1.35f * size;
  }
}

}  // namespace dance

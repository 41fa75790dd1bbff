// Overlay: name tags over heads and the figures of each guest, drawn over the finished picture with
// Dear ImGui's draw lists. Places are computed here and not by its windows, so that the first
// picture is as good as the second.
//
// Units/frames: pixels from the top left; `scale` is the monitor's (1 = 96 dpi).
// Ownership:    owns the ImGui context and its OpenGL objects; one per process.
// Threads:      the one whose OpenGL context is current.
// Failure:      create() tells when ImGui cannot start; without the DejaVu font it takes ImGui's
//               own, and font_note() says so.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/base/result.h"
#include "viewer/overlay/imgui_on_gl.h"
#include "viewer/scene/camera.h"
#include "viewer/scene/comparison.h"
#include "viewer/scene/scene.h"
#include "viewer/scene/stage_picture.h"
#include "viewer/words/texts.h"

struct ImDrawList;
struct ImFont;

namespace dance {

class PanelStack;
struct PanelFrame;

struct OverlayChoice {
  bool tags = true;
  bool hud = true;
  std::string title = {};        // at the top left, where there are no figures
  std::string caption = {};      // in the middle of the bottom
  PanelStack* panels = nullptr;  // over the whole picture
  // Where the tag of each guest hangs; empty: over the dancers' own heads.
  std::span<const Eigen::Vector3f> tag_anchors_W_m = {};
  // Of a picture with several stages: who is meant by panels, and the lines at the bottom left.
  const SceneState* whole = nullptr;
};

class Overlay {
 public:
  static Result<std::unique_ptr<Overlay>> create(float scale);
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  // Makes the fonts anew where the scale has changed (a window moved to another monitor).
  void set_scale(float scale);
  // Draws onto the bound framebuffer.
  void draw(const SceneState& scene, const OrbitCamera& camera, int width_px, int height_px,
            const OverlayChoice& choice);
  // Round the stages of a picture with several; notes and panels over all.
  void draw_frames(std::span<const StageCell> cells, int width_px, int height_px,
                   const OverlayChoice& choice);
  // The beats under the two halves of a comparison, in the lowest panel_height_px() of the bound
  // framebuffer.
  void draw_beats(const Comparison& comparison, int width_px, int height_px, PanelStack* panels);
  int panel_height_px(int height_px) const;
  const std::string& font_note() const { return font_note_; }
  // The language of notes, panels and the names that programs gave.
  void set_language(Language language) { texts_ = Texts(language); }

 private:
  explicit Overlay(float scale) : scale_(scale) {}
  void make_fonts();
  void draw_tags(const SceneState& scene, const OrbitCamera& camera,
                 std::span<const Eigen::Vector3f> anchors_W_m, float width_px, float height_px);
  void draw_hud(const SceneState& scene);
  void draw_words(const OverlayChoice& choice, float width_px, float height_px);
  void draw_notes(const SceneState& scene, float height_px);
  PanelFrame frame_of(const SceneState& scene, float width_px, float height_px) const;

  ImguiOnGl imgui_;
  float scale_;
  ImFont* tag_font_ = nullptr;
  ImFont* hud_font_ = nullptr;
  ImFont* digit_font_ = nullptr;
  Texts texts_{Language::kEnglish};
  std::string font_note_;
};

}  // namespace dance

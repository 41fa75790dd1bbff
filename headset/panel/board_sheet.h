// BoardSheet: one texture with all that is written in the stage of a headset: the panel of the
// wrist, and the name tags of the guests.
//
// Units/frames: pixels of the sheet; boards in W.
// Ownership:    owns the texture and Dear ImGui's context; one per process, and not beside an
//               Overlay.
// Threads:      the one whose OpenGL context is current.
// Failure:      create() tells when ImGui cannot start. Tags beyond kMostTags are left out.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "headset/panel/wrist_panel.h"
#include "headset/stereo/board_painter.h"
#include "viewer/overlay/imgui_on_gl.h"
#include "viewer/scene/scene.h"
#include "viewer/words/texts.h"

struct ImFont;

namespace dance {

// What the panel says.
struct PanelWords {
  enum class Advice : std::uint8_t { kNone, kTPoseIsBetter, kStandInTPose };

  std::string title;  // who dances
  int tracked = 0;    // how many points
  Advice advice = Advice::kNone;
  float progress = 0.0f;  // of standing still in T-pose
  bool has_voice = false, is_muted = false;
};

class BoardSheet {
 public:
  static constexpr std::size_t kMostTags = 44;

  static Result<std::unique_ptr<BoardSheet>> create(Language language);
  BoardSheet(const BoardSheet&) = delete;
  BoardSheet& operator=(const BoardSheet&) = delete;

  // Draws the texture again if its content changed; leaves another framebuffer bound.
  void draw(const WristPanel& panel, const PanelWords& words, std::span<const SceneGuest> guests,
            const ShownNames& names = {});
  // Appends the tags of draw()'s guests, facing `eye_W_m`, from far to near; guests with hidden
  // heads have none. `anchors_W_m`: the places above their heads, one for each guest.
  void append_tags(std::span<const SceneGuest> guests, std::span<const Eigen::Vector3f> anchors_W_m,
                   const Eigen::Vector3f& eye_W_m, std::vector<Board>& boards) const;
  void append_panel(const WristPanel& panel, std::vector<Board>& boards) const;
  const GlTexture& texture() const { return texture_; }

 private:
  explicit BoardSheet(Language language) : texts_(language) {}
  void make_texture();
  void draw_panel(const WristPanel& panel, const PanelWords& words);
  void draw_button(PanelAction action, const char* label, bool is_on, const WristPanel& panel);
  void draw_tag(std::size_t place, const SceneGuest& guest);
  std::string content_of(const WristPanel& panel, const PanelWords& words,
                         std::span<const SceneGuest> guests) const;

  Texts texts_;
  ShownNames names_;  // of draw()
  ImguiOnGl imgui_;
  ImFont* large_ = nullptr;
  ImFont* small_ = nullptr;
  GlTexture texture_;
  GlFramebuffer framebuffer_;
  std::string drawn_;                 // what is on it
  std::vector<float> tag_widths_px_;  // of the guests of draw(); 0: none
};

}  // namespace dance

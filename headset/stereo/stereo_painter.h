// StereoPainter: a scene as two eyes see it: figures posed and shadows drawn once, then each eye's
// picture with what is written in the stage, copied into an image of the headset's runtime.
//
// Units/frames: W; pixels of one eye.
// Ownership:    owns renderer, boards and what is written on them; the OpenGL context must outlive
//               it. One per process, as Dear ImGui is.
// Threads:      the one whose context is current.
// Failure:      create() and prepare() tell what the driver refuses.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "headset/comfort/comfort.h"
#include "headset/panel/board_sheet.h"
#include "headset/stereo/board_painter.h"
#include "viewer/stage/stage_renderer.h"

namespace dance {

struct StereoWishes {
  GuestId own;
  ComfortSettings comfort;
  float darkness = 0.0f;
  bool tags = true;
  Venue place = Venue::kPlain;
};

class StereoPainter {
 public:
  static Result<std::unique_ptr<StereoPainter>> create(Quality quality, Language language);

  // Poses figures and draws shadows, and writes what is to be read. The own guest's head is hidden.
  Result<void> prepare(SceneState& scene, const std::array<StageEye, 2>& eyes, int width_px,
                       int height_px, const WristPanel& panel, const PanelWords& words,
                       const StereoWishes& wishes);
  // The picture of one of the eyes of prepare(), left in finished().
  void paint(std::size_t eye);
  // Copies it into a texture of the same size.
  void copy_to(GLuint texture);
  // Copies it to the window's own framebuffer, as large as fits.
  void show_in_window(int width_px, int height_px) const;

  StageRenderer& renderer() { return *renderer_; }
  const GlFramebuffer& finished() const { return renderer_->target().finished(); }

 private:
  explicit StereoPainter(BoardPainter boards) : board_painter_(std::move(boards)) {}
  void find_tag_anchors(const SceneState& scene);

  std::unique_ptr<StageRenderer> renderer_;
  std::unique_ptr<BoardSheet> sheet_;
  BoardPainter board_painter_;
  GlFramebuffer copy_;
  std::array<StageEye, 2> eyes_;
  std::vector<Eigen::Vector3f> tag_anchors_W_m_;
  std::vector<Board> boards_;
  float darkness_ = 0.0f;
  int width_px_ = 0, height_px_ = 0;
};

}  // namespace dance

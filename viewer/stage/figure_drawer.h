// FigureDrawer: draws posed figures: all of one model and level of detail in one instanced call for
// each of its batches. The joints of all figures lie in one buffer that is filled once a picture.
//
// Units/frames: W.
// Ownership:    owns its OpenGL objects; the context must outlive it. Borrows the figures for
//               take() only.
// Threads:      the one whose context is current.
// Failure:      take() tells what the driver refuses. Figures beyond the card's largest buffer
//               texture are left out.
#pragma once

#include <span>
#include <vector>

#include "viewer/figure/figure_poser.h"
#include "viewer/scene/camera.h"
#include "viewer/stage/figure_programs.h"
#include "viewer/stage/figure_store.h"
#include "viewer/stage/stage_light.h"
#include "viewer/stage/stage_look.h"

namespace dance {

// Mirror images are coarser and show all heads. Mirroring reverses the winding of triangles.
enum class FigureImage { kNone, kInFloor, kInMirror };

// What a picture cost.
struct DrawnFigures {
  std::size_t figures = 0;
  std::size_t triangles = 0;  // with those of shadows and mirror images
  std::size_t calls = 0;
};

class FigureDrawer {
 public:
  explicit FigureDrawer(Quality quality);

  FigureStore& store() { return store_; }
  // Chooses levels of detail and uploads the joints.
  Result<void> take(std::span<const PosedFigure> figures, const StageEye& eye,
                    const StageLook& look);
  // Indices of the figures of take() whose mesh is not there yet.
  std::span<const std::size_t> waiting() const { return waiting_; }

  void draw_shadows(const Eigen::Matrix4f& light_from_world);
  // kInFloor takes the picture's matrix and the eye mirrored below the floor; kInMirror takes the
  // matrix and the eye of the mirror.
  void draw_solid(const StageLight& light, const Eigen::Matrix4f& clip_from_world,
                  const Eigen::Vector3f& eye_W_m, FigureImage image);
  void draw_blended(const StageLight& light, const Eigen::Matrix4f& clip_from_world,
                    const Eigen::Vector3f& eye_W_m);
  const DrawnFigures& drawn() const { return drawn_; }

 private:
  struct Figure {
    std::size_t index = 0;
    const FigureGpu* gpu = nullptr;
    std::size_t level = 0;
    bool is_fading = false;
    bool is_eye = false;
    float depth_m = 0.0f;
  };
  struct Layout {  // of one figure in the buffer, texels
    int morph_weights = 0;
    int stride = 0;
  };
  struct Group {  // figures that one call draws
    const FigureGpu* gpu = nullptr;
    std::size_t level = 0;
    bool is_eye = false;
    bool has_morphs = false;
    bool is_fading = false;
    Layout layout;
    int first_texel = 0;
    int count = 0;
    float depth_m = 0.0f;  // of its first figure
  };

  static Layout layout_of(const PosedFigure& figure);
  void choose(std::span<const PosedFigure> figures, const StageEye& eye, const StageLook& look);
  void write(const PosedFigure& figure, const Layout& layout);
  void group(std::span<const PosedFigure> figures);
  void upload();
  void begin(const FigureProgram& program) const;
  void draw(const FigureProgram& program, const Group& group, std::size_t batch, std::size_t level,
            bool without_head);
  bool is_shown(const FigureBatch& batch, const Group& group, bool is_seen_by_itself) const;

  Quality quality_;
  FigureStore store_;
  FigurePrograms programs_;
  GlBuffer joint_buffer_;
  GlTexture joints_;
  std::size_t most_texels_;
  std::vector<Figure> figures_;
  std::vector<std::size_t> waiting_;
  std::vector<Group> groups_;   // by model and level
  std::vector<Group> shadows_;  // by model
  std::vector<Group> blended_;  // of one figure each, from far to near
  std::vector<float> texels_;
  DrawnFigures drawn_;
};

}  // namespace dance

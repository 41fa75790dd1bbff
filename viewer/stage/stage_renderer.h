// StageRenderer: draws the stage — the place or the plain floor, figures, their shadows and mirror
// images, the beat and the trails of hands — from a SceneState and a camera.
//
// Units/frames: metres in W; the finished picture is 8-bit sRGB.
// Ownership:    owns its OpenGL objects; the context must outlive it. All of them come from the
//               scenes it is given: one destroyed and made anew draws the same.
// Threads:      the one whose context is current.
// Failure:      create() and draw() tell what the driver refuses; OpenGL errors are our bugs
//               (check_gl()).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>

#include "viewer/figure/figure_poser.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/picture_target.h"
#include "viewer/scene/camera.h"
#include "viewer/scene/scene.h"
#include "viewer/stage/figure_drawer.h"
#include "viewer/stage/floor_painter.h"
#include "viewer/stage/place/limb_painter.h"
#include "viewer/stage/place/place_painter.h"
#include "viewer/stage/ribbon_painter.h"
#include "viewer/stage/stage_light.h"
#include "viewer/stage/stage_look.h"

namespace dance {

class StageRenderer {
 public:
  static Result<std::unique_ptr<StageRenderer>> create(Quality quality);

  // The direction the key light comes from, about the vertical, as the camera's yaw.
  void set_light_yaw(float yaw_rad) { light_.set_yaw(yaw_rad); }
  void set_look(const StageLook& look) { look_ = look; }
  // A dancer who comes then does not stop the picture; until the figure is ready a ring of light
  // shows the place. Without this the first picture waits for it.
  void build_meshes_beside() { build_meshes(MeshMaker::When::kBeside); }
  // The last picture showed a ring of light where a figure is not ready.
  bool is_waiting() const { return !waiting_.empty(); }
  void build_meshes(MeshMaker::When when) { figures_.store().maker().set_when(when); }
  MeshMaker::When meshes_when() { return figures_.store().maker().when(); }

  // Leaves the finished picture in target().finished(), bound: prepare(), then paint().
  Result<void> draw(const SceneState& scene, const OrbitCamera& camera, int width_px,
                    int height_px);
  // Poses the figures and uploads their joints.
  Result<void> prepare(const SceneState& scene, const OrbitCamera& camera, int width_px,
                       int height_px);
  Result<void> prepare(const SceneState& scene, const StageEye& eye, int width_px, int height_px);
  void paint();
  // paint() in parts, for several eyes of one prepare(): shadows once, then each eye's picture,
  // which leaves target().finished() as draw() does. `more` is called last, to draw into the
  // stage's light with its depth.
  void paint_shadows();
  using PaintMore = std::function<void(const StageEye& eye)>;
  void paint_eye(const StageEye& eye, const PaintMore& more = {});

  // Of the last prepare(), until the next.
  std::span<const PosedFigure> figures() const { return posed_; }
  const DrawnFigures& drawn() const { return figures_.drawn(); }
  FigureStore& store() { return figures_.store(); }
  const PictureTarget& target() const { return target_; }
  Quality quality() const { return quality_; }

 private:
  // What each of several stages keeps from picture to picture.
  struct Memory {
    FigurePoser poser;
    HandTrails trails;
    std::uint64_t last_used = 0;
  };
  Memory& memory_of(int stage);

  struct Painters {
    FloorPainter floor;
    PlacePainter place;
    LimbPainter limbs;
    RibbonPainter ribbons;
  };
  StageRenderer(Quality quality, Painters painters);
  Result<void> link_programs();
  void gather(const SceneState& scene);
  StageArea floor_area() const;
  bool has_place() const { return look_.place != Venue::kPlain; }
  void paint_plain(const StageEye& eye);
  void paint_place(const StageEye& eye);
  void paint_images(const StageEye& eye, const std::optional<PlaceMirror>& mirror);
  void draw_backdrop(const StageEye& eye);
  void finish_picture();

  Quality quality_;
  StageLook look_;
  PictureTarget target_;
  StageLight light_;
  FigureDrawer figures_;
  FloorPainter floor_;
  PlacePainter place_;
  LimbPainter limb_painter_;
  RibbonPainter ribbons_;
  GlProgram backdrop_;
  GlProgram finish_;
  GlVertexArray no_vertices_;
  std::map<int, Memory> memories_;  // by StageLook::stage
  std::uint64_t picture_ = 0;

  // Of the picture that prepare() has begun.
  std::span<const PosedFigure> posed_;
  std::vector<ContactSpot> spots_;
  std::vector<WaitingGuest> waiting_;
  std::vector<SoftLimb> limbs_;  // for a mirror, in low quality
  std::vector<RibbonVertex> trail_triangles_;
  StageArea area_;
  BeatPulse pulse_;
  StageEye eye_;
};

}  // namespace dance

#include "viewer/program/export_painter.h"

namespace dance {
namespace {
// Hair and skirts of the export are not those of the window that is drawn in between.
constexpr int kStageOfExport = 1'000;
}  // namespace

Result<Picture> ExportPainter::paint(SceneState& scene, Duration passed, bool jumps,
                                     AvatarLibrary& avatars, StagePainter& painter) {
  const ViewDirector::Size size{size_.width_px, size_.height_px,
                                painter.overlay().panel_height_px(size_.height_px)};
  avatars.wait_and_dress(scene);
  scene.notes.clear();
  scene.shows_trails = trails_;
  if (jumps)
    view_.jump(scene, size);
  else
    view_.update(scene, size, passed);
  painter.set_look({.stage = kStageOfExport});
  // A picture in a file waits for its figures; a window shows a ring until they are built.
  const MeshMaker::When when = painter.renderer().meshes_when();
  painter.renderer().build_meshes(MeshMaker::When::kAtOnce);
  const OverlayChoice choice{tags_, false};
  painter.renderer().set_light_yaw(view_.light_yaw_rad());
  auto drawn = view_.comparison()
                   ? painter.draw(*view_.comparison(), view_.camera(), size_.width_px,
                                  size_.height_px, choice)
                   : painter.draw(view_.cells(), size_.width_px, size_.height_px, choice);
  painter.renderer().build_meshes(when);
  painter.set_look({});
  if (!drawn) return tl::make_unexpected(drawn.error());
  return painter.read();
}

}  // namespace dance

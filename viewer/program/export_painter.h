// ExportPainter: draws the pictures of an export as the view shows the stage, without notes and
// panels.
//
// Units/frames: pixels.
// Ownership:    a camera of its own, copied from the view; borrows avatars and painter for a call.
// Threads:      the drawing thread.
// Failure:      paint() names what the driver refuses.
#pragma once

#include "viewer/avatar/avatar_library.h"
#include "viewer/gl/picture.h"
#include "viewer/program/view_options.h"
#include "viewer/stage/stage_painter.h"
#include "viewer/view/view_director.h"

namespace dance {

class ExportPainter {
 public:
  ExportPainter(const ViewDirector& view, ViewPictureSize size, bool tags, bool trails)
      : view_(view), size_(size), tags_(tags), trails_(trails) {}

  // The first picture's camera jumps to its place where no window was there before.
  Result<Picture> paint(SceneState& scene, Duration passed, bool jumps, AvatarLibrary& avatars,
                        StagePainter& painter);

 private:
  ViewDirector view_;
  ViewPictureSize size_;
  bool tags_;
  bool trails_;
};

}  // namespace dance

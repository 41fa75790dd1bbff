// RibbonPainter: draws the trails of hands over the finished figures: behind what is nearer, and
// into each other.
//
// Units/frames: W.
// Ownership:    owns its OpenGL objects; the context must outlive it.
// Threads:      the one whose context is current.
// Failure:      create() tells what the driver refuses.
#pragma once

#include <span>

#include "viewer/gl/gl_objects.h"
#include "viewer/stage/hand_trails.h"

namespace dance {

class RibbonPainter {
 public:
  static Result<RibbonPainter> create();
  void draw(const Eigen::Matrix4f& clip_from_world, std::span<const RibbonVertex> triangles);

 private:
  RibbonPainter();

  GlProgram program_;
  GlVertexArray array_;
  GlBuffer buffer_;
};

}  // namespace dance

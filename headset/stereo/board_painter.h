// BoardPainter: flat pictures that stand in the stage, such as name tags and the panel at a wrist,
// and the darkness that lies over a whole picture for a moment.
//
// Units/frames: metres in W; places on the sheet 0 to 1 from its top left.
// Ownership:    owns its OpenGL objects; borrows the sheet's texture.
// Threads:      the one whose OpenGL context is current.
// Failure:      create() tells what the driver refuses.
#pragma once

#include <Eigen/Core>
#include <span>

#include "viewer/gl/gl_objects.h"
#include "viewer/scene/camera.h"

namespace dance {

struct Board {
  Eigen::Vector3f centre_W_m = Eigen::Vector3f::Zero();
  Eigen::Matrix3f axes_W = Eigen::Matrix3f::Identity();  // right, up, to where it is seen from
  float width_m = 0.1f, height_m = 0.1f;
  float u0 = 0.0f, v0 = 0.0f, u1 = 1.0f, v1 = 1.0f;  // its picture on the sheet
  float opacity = 1.0f;
};

class BoardPainter {
 public:
  static Result<BoardPainter> create();

  // Into the stage's light; from far to near is the caller's to order. The sheet's colours are
  // premultiplied, as a screen shows them.
  void draw(const StageEye& eye, std::span<const Board> boards, const GlTexture& sheet);
  // 0: nothing; 1: black.
  void darken(float darkness);

 private:
  BoardPainter() : no_vertices_(GlVertexArray::make()) {}

  GlProgram board_, dark_;
  GlVertexArray no_vertices_;
};

}  // namespace dance

// LimbPainter: draws dancers in a mirror as soft capsules along their limbs, in their colours. Low
// quality uses it, because drawing the figures a second time is too slow there.
//
// Units/frames: W.
// Ownership:    owns its OpenGL objects; the context must outlive it.
// Threads:      the one whose context is current.
// Failure:      create() returns the driver's error.
#pragma once

#include <span>
#include <vector>

#include "viewer/figure/figure_poser.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/scene/camera.h"

namespace dance {

struct SoftLimb {
  Eigen::Vector3f from_W_m;
  float radius_m;
  Eigen::Vector3f to_W_m;
  float opacity;
  Eigen::Vector3f colour;
};

// Sorts the limbs for a mirror in a plane of constant z behind the figures: the figure nearest to
// the mirror is last.
void make_soft_limbs(std::span<const PosedFigure> figures, std::vector<SoftLimb>& limbs);

class LimbPainter {
 public:
  static Result<LimbPainter> create();
  // Draws in the given order, each limb over those before it.
  void draw(const StageEye& eye, std::span<const SoftLimb> limbs) const;

 private:
  LimbPainter();

  GlProgram program_;
  GlVertexArray array_;
  GlBuffer buffer_;
};

}  // namespace dance

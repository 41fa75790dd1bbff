// The head of an avatar as a surface that features of the face are laid onto: brows, mouth, eyes.
//
// Units/frames: local places are metres of a body 1.72 m tall in the axes of the head, from its
//               joint: chin at y = −0.01, eyes at 0.088, crown at 0.2, nose towards +Z. What comes
//               out is in T-pose, W, scaled to the dancer.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      on() beside the head gives a place at its side.
#pragma once

#include <memory>

#include "formats/avatar/make/avatar_design.h"
#include "formats/body/figure_builder.h"
#include "formats/body/implicit_surface.h"

namespace dance {

class FaceSurface {
 public:
  FaceSurface(const TposePlaces& places, const AvatarDesign& design);

  const FigureLayer& layer() const { return layer_; }  // skin of head and neck
  float scale() const { return scale_; }
  Eigen::Vector3f at(const Eigen::Vector3f& local_m) const { return head_m_ + scale_ * local_m; }
  // Seen from the front at x, y: the place on the skin, lifted off it.
  Eigen::Vector3f on(float x_m, float y_m, float lift_m) const;

 private:
  FigurePart part(const Eigen::Vector3f& a_m, float radius_a_m, const Eigen::Vector3f& b_m,
                  float radius_b_m, float width = 1.0f, float depth = 1.0f) const;
  void add_skull(FaceShape shape);
  void add_features(FaceShape shape);

  Eigen::Vector3f head_m_;
  Eigen::Vector3f neck_m_;
  float scale_;
  FigureLayer layer_;
  std::unique_ptr<const LayerDistance> distance_;  // of the whole layer
};

}  // namespace dance

#include "formats/avatar/make/face/face_surface.h"

namespace dance {

using Eigen::Vector3f;

FaceSurface::FaceSurface(const TposePlaces& places, const AvatarDesign& design)
    : head_m_(places.at(Bone::kHead)), neck_m_(places.at(Bone::kNeck)), scale_(places.scale) {
  layer_.material = Material::kSkin;
  layer_.cell_m = scale_ * 0.0075f;
  layer_.blend_m = scale_ * 0.018f;
  layer_.skinning = FigureSkinning::kNeck;
  add_skull(design.face);
  add_features(design.face);
  distance_ = std::make_unique<const LayerDistance>(layer_);
}

FigurePart FaceSurface::part(const Vector3f& a_m, float radius_a_m, const Vector3f& b_m,
                             float radius_b_m, float width, float depth) const {
  FigurePart part;
  part.a_m = at(a_m);
  part.b_m = at(b_m);
  part.radius_a_m = scale_ * radius_a_m;
  part.radius_b_m = scale_ * radius_b_m;
  part.width = width;
  part.depth = depth;
  return part;
}

void FaceSurface::add_skull(FaceShape shape) {
  const bool strong = shape == FaceShape::kStrong;
  FigurePart neck =
      part({0, 0, 0}, strong ? 0.058f : 0.047f, {0, 0.03f, -0.004f}, strong ? 0.054f : 0.045f);
  neck.a_m = neck_m_ + scale_ * Vector3f(0, -0.035f, 0.0f);
  layer_.parts.push_back(neck);
  layer_.parts.push_back(
      part({0, 0.108f, -0.008f}, 0.084f, {0, 0.114f, -0.008f}, 0.084f, 0.88f, 1.08f));
  // From brow to chin; two more at the corners of the jaw.
  layer_.parts.push_back(
      part({0, 0.095f, 0.02f}, 0.066f, {0, 0.03f, 0.04f}, strong ? 0.042f : 0.036f, 1.03f));
  layer_.parts.push_back(part({0, 0.012f, 0.056f}, strong ? 0.024f : 0.019f, {0, 0.012f, 0.056f},
                              0.019f, strong ? 1.25f : 1.0f));
  for (const float s : {1.0f, -1.0f})
    layer_.parts.push_back(part({0.044f * s, strong ? 0.038f : 0.045f, 0.012f},
                                strong ? 0.0225f : 0.02f, {0.012f * s, 0.014f, 0.05f},
                                strong ? 0.02f : 0.016f));
}

void FaceSurface::add_features(FaceShape shape) {
  const bool strong = shape == FaceShape::kStrong;
  // Bridge and tip of the nose, and its wings.
  layer_.parts.push_back(part({0, 0.098f, 0.079f}, strong ? 0.007f : 0.0055f, {0, 0.066f, 0.098f},
                              strong ? 0.0095f : 0.0075f));
  for (const float s : {1.0f, -1.0f}) {
    const float wing_m = strong ? 0.007f : 0.0055f;
    layer_.parts.push_back(
        part({0.008f * s, 0.062f, 0.088f}, wing_m, {0.008f * s, 0.062f, 0.088f}, wing_m));
    // Full cheeks: hollow cheeks look ill in stage light.
    layer_.parts.push_back(
        part({0.03f * s, 0.05f, 0.046f}, 0.031f, {0.036f * s, 0.058f, 0.04f}, 0.029f));
    // Cheekbones, brow ridges, ears.
    layer_.parts.push_back(
        part({0.036f * s, 0.066f, 0.05f}, 0.021f, {0.05f * s, 0.074f, 0.03f}, 0.018f));
    layer_.parts.push_back(part({0.014f * s, 0.116f, 0.073f}, strong ? 0.012f : 0.009f,
                                {0.046f * s, 0.113f, 0.053f}, 0.01f));
    layer_.parts.push_back(
        part({0.077f * s, 0.098f, -0.008f}, 0.019f, {0.073f * s, 0.072f, 0.0f}, 0.012f, 0.45f));
  }
}

Vector3f FaceSurface::on(float x_m, float y_m, float lift_m) const {
  constexpr int kHalvings = 18;
  float outside_m = 0.16f;
  float inside_m = -0.02f;
  for (int i = 0; i < kHalvings; ++i) {
    const float z_m = 0.5f * (outside_m + inside_m);
    (distance_->at(at({x_m, y_m, z_m})) > 0.0f ? outside_m : inside_m) = z_m;
  }
  const Vector3f place = at({x_m, y_m, outside_m});
  constexpr float kStep_m = 1e-3f;
  Vector3f out;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3f step = kStep_m * Vector3f::Unit(axis);
    out[axis] = distance_->at(place + step) - distance_->at(place - step);
  }
  return place + scale_ * lift_m * out.normalized();
}

}  // namespace dance

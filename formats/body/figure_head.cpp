#include "formats/body/figure_builder.h"

namespace dance {

using Eigen::Vector3f;

// Local places are in the axes of the head, from its joint at the base of the skull: chin at
// y = −0.01, eyes at 0.09, crown at 0.2, nose towards +Z.

void FigureBuilder::add_head() {
  FigureLayer& skin = layer(Material::kSkin, 0.0085f, 0.012f, FigureSkinning::kNeck);
  skin.parts.push_back(part(at(Bone::kNeck, {0, -0.03f, 0.002f}), 0.057f,
                            at(Bone::kHead, {0, 0.03f, 0.004f}), 0.051f));
  skin.parts.push_back(part(at(Bone::kHead, {0, 0.106f, -0.004f}), 0.087f,
                            at(Bone::kHead, {0, 0.112f, -0.004f}), 0.087f, 0.87f, 1.08f));
  skin.parts.push_back(part(at(Bone::kHead, {0, 0.095f, 0.022f}), 0.07f,
                            at(Bone::kHead, {0, 0.022f, 0.046f}), 0.04f, 1.04f));
  skin.parts.push_back(part(at(Bone::kHead, {0, 0.09f, 0.09f}), 0.008f,
                            at(Bone::kHead, {0, 0.062f, 0.1f}), 0.0125f));
  if (look_.hair_style == Hair::kBob) return;  // which covers the ears
  for (const float s : {1.0f, -1.0f})
    skin.parts.push_back(part(at(Bone::kHead, {0.075f * s, 0.092f, -0.006f}), 0.02f,
                              at(Bone::kHead, {0.072f * s, 0.068f, 0.0f}), 0.013f, 0.5f));
}

void FigureBuilder::add_face() {
  const auto head_layer = [this](Material material, float cell_m) -> FigureLayer& {
    return layer(material, cell_m, 0.0f, FigureSkinning::kHead);
  };
  FigureLayer& lips = head_layer(Material::kLips, 0.004f);
  FigurePart mouth = part(at(Bone::kHead, {-0.015f, 0.036f, 0.0835f}), 0.0065f,
                          at(Bone::kHead, {0.015f, 0.036f, 0.0835f}), 0.0065f, 0.62f);
  mouth.side = Vector3f::UnitY();
  lips.parts.push_back(mouth);
  for (const float s : {1.0f, -1.0f}) {
    const Vector3f ball = at(Bone::kHead, {0.03f * s, 0.09f, 0.0765f});
    head_layer(Material::kEyeWhite, 0.004f).parts.push_back(part(ball, 0.0122f, ball, 0.0122f));
    const Vector3f iris = at(Bone::kHead, {0.0295f * s, 0.09f, 0.0825f});
    head_layer(Material::kIris, 0.003f).parts.push_back(part(iris, 0.0082f, iris, 0.0082f));
    head_layer(Material::kHair, 0.0025f)
        .parts.push_back(part(at(Bone::kHead, {0.018f * s, 0.115f, 0.0885f}), 0.0036f,
                              at(Bone::kHead, {0.045f * s, 0.113f, 0.077f}), 0.003f));
  }
}

void FigureBuilder::add_hair() {
  FigureLayer& hair = layer(Material::kHair, 0.011f, 0.01f, FigureSkinning::kHead);
  const auto add = [&](const Vector3f& a, float radius_a_m, const Vector3f& b, float radius_b_m,
                       float width = 1.0f, float depth = 1.0f) {
    hair.parts.push_back(
        part(at(Bone::kHead, a), radius_a_m, at(Bone::kHead, b), radius_b_m, width, depth));
  };
  add({0, 0.119f, -0.019f}, 0.089f, {0, 0.13f, -0.014f}, 0.087f, 0.95f);
  switch (look_.hair_style) {
    case Hair::kShort:
      add({0, 0.1f, -0.032f}, 0.076f, {0, 0.05f, -0.03f}, 0.06f);
      break;
    case Hair::kBob:
      add({0, 0.11f, -0.026f}, 0.09f, {0, 0.03f, -0.028f}, 0.087f, 1.04f, 0.86f);
      break;
    case Hair::kBun:
      add({0, 0.1f, -0.032f}, 0.076f, {0, 0.07f, -0.03f}, 0.066f);
      add({0, 0.165f, -0.108f}, 0.046f, {0, 0.165f, -0.108f}, 0.046f);
      break;
    case Hair::kPonytail:
      add({0, 0.1f, -0.032f}, 0.076f, {0, 0.07f, -0.03f}, 0.066f);
      add({0, 0.145f, -0.108f}, 0.03f, {0, 0.075f, -0.155f}, 0.04f);
      add({0, 0.075f, -0.155f}, 0.04f, {0, -0.045f, -0.165f}, 0.012f);
      break;
  }
}

}  // namespace dance

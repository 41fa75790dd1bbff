#include "viewer/stage/mannequin_builder.h"

namespace dance {

using Eigen::Vector3f;

namespace {
// Local places below are in the axes of the head, from its joint at the base of the skull: chin at
// y = −0.01, eyes at 0.09, crown at 0.2, nose towards +Z.
constexpr Vector3f::Scalar kEyeHeight_m = 0.09f;
}  // namespace

void MannequinBuilder::add_head() {
  const Vector3f x = axis(Bone::kHead, Vector3f::UnitX());
  large(cone(at(Bone::kNeck, {0, -0.02f, 0.002f}), 0.057f, at(Bone::kHead, {0, 0.03f, 0.004f}),
             0.051f, axis(Bone::kNeck, Vector3f::UnitX()), skin_));
  BodyPart skull = cone(at(Bone::kHead, {0, 0.106f, -0.004f}), 0.087f,
                        at(Bone::kHead, {0, 0.112f, -0.004f}), 0.087f, x, skin_);
  skull.width = 0.87f;
  skull.depth = 1.08f;
  large(skull);
  BodyPart jaw = cone(at(Bone::kHead, {0, 0.095f, 0.022f}), 0.07f,
                      at(Bone::kHead, {0, 0.022f, 0.046f}), 0.04f, x, skin_);
  jaw.width = 1.04f;
  large(jaw);
  add_face();
  add_hair();
}

void MannequinBuilder::add_face() {
  const Vector3f x = axis(Bone::kHead, Vector3f::UnitX());
  const Colour eye{Vector3f(0.015f, 0.012f, 0.012f), 0.9f};
  const Colour white{Vector3f(0.8f, 0.78f, 0.75f), 0.5f};
  const Colour lips{look_.skin.cwiseProduct(Vector3f(0.75f, 0.38f, 0.36f)), 0.3f};
  small(cone(at(Bone::kHead, {0, 0.09f, 0.09f}), 0.008f, at(Bone::kHead, {0, 0.062f, 0.1f}),
             0.0125f, x, skin_));
  BodyPart mouth = cone(at(Bone::kHead, {-0.015f, 0.036f, 0.0835f}), 0.0065f,
                        at(Bone::kHead, {0.015f, 0.036f, 0.0835f}), 0.0065f,
                        axis(Bone::kHead, Vector3f::UnitY()), lips);
  mouth.width = 0.62f;
  small(mouth);
  for (const float s : {1.0f, -1.0f}) {
    const Vector3f ball = at(Bone::kHead, {0.03f * s, kEyeHeight_m, 0.0765f});
    small(cone(ball, 0.0122f, ball, 0.0122f, x, white));
    const Vector3f iris = at(Bone::kHead, {0.0295f * s, kEyeHeight_m, 0.0825f});
    small(cone(iris, 0.0082f, iris, 0.0082f, x, eye));
    small(cone(at(Bone::kHead, {0.018f * s, 0.115f, 0.0885f}), 0.0036f,
               at(Bone::kHead, {0.045f * s, 0.113f, 0.077f}), 0.003f, x, hair_));
    BodyPart ear = cone(at(Bone::kHead, {0.075f * s, 0.092f, -0.006f}), 0.02f,
                        at(Bone::kHead, {0.072f * s, 0.068f, 0.0f}), 0.013f, x, skin_);
    ear.width = 0.45f;
    small(ear);
  }
}

void MannequinBuilder::add_hair() {
  const Vector3f x = axis(Bone::kHead, Vector3f::UnitX());
  BodyPart cap = cone(at(Bone::kHead, {0, 0.119f, -0.019f}), 0.089f,
                      at(Bone::kHead, {0, 0.13f, -0.014f}), 0.087f, x, hair_);
  cap.width = 0.95f;
  large(cap);
  switch (look_.hair_style) {
    case Hair::kShort: {
      large(cone(at(Bone::kHead, {0, 0.1f, -0.032f}), 0.076f, at(Bone::kHead, {0, 0.05f, -0.03f}),
                 0.06f, x, hair_));
      break;
    }
    case Hair::kBob: {
      BodyPart fall = cone(at(Bone::kHead, {0, 0.11f, -0.026f}), 0.09f,
                           at(Bone::kHead, {0, 0.012f, -0.022f}), 0.08f, x, hair_);
      fall.width = 1.02f;
      fall.depth = 0.86f;
      fall.flat_b = 0.35f;
      large(fall);
      break;
    }
    case Hair::kBun: {
      large(cone(at(Bone::kHead, {0, 0.1f, -0.032f}), 0.076f, at(Bone::kHead, {0, 0.07f, -0.03f}),
                 0.066f, x, hair_));
      const Vector3f bun = at(Bone::kHead, {0, 0.165f, -0.108f});
      large(cone(bun, 0.046f, bun, 0.046f, x, hair_));
      break;
    }
    case Hair::kPonytail: {
      large(cone(at(Bone::kHead, {0, 0.1f, -0.032f}), 0.076f, at(Bone::kHead, {0, 0.07f, -0.03f}),
                 0.066f, x, hair_));
      // Hangs between the head's own down and that of the world.
      const Vector3f root = at(Bone::kHead, {0, 0.145f, -0.108f});
      const Vector3f down =
          (axis(Bone::kHead, {0, -0.5f, -0.25f}) - 0.5f * Vector3f::UnitY()).normalized();
      const Vector3f middle = root + scale_ * 0.09f * (down + axis(Bone::kHead, {0, 0, -0.4f}));
      large(cone(root, 0.03f, middle, 0.04f, x, hair_));
      large(cone(middle, 0.04f, middle + scale_ * 0.13f * down, 0.012f, x, hair_));
      break;
    }
  }
}

}  // namespace dance

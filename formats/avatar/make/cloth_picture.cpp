#include "formats/avatar/make/cloth_picture.h"

#include <cmath>

#include "formats/avatar/make/sheet.h"

namespace dance {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int kCloth_px = 256;
constexpr int kEye_px = 128;

template <class ColourAt>
AvatarPicture drawn_picture(int size_px, ColourAt colour_at) {
  AvatarPicture picture;
  picture.width_px = size_px;
  picture.height_px = size_px;
  for (int y = 0; y < size_px; ++y)
    for (int x = 0; x < size_px; ++x) {
      const Vector2f uv(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const Vector3f srgb = srgb_from_linear(colour_at(Vector2f(uv / static_cast<float>(size_px))));
      for (int c = 0; c < 3; ++c)
        picture.rgba.push_back(
            static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(srgb[c], 0.0f, 1.0f))));
      picture.rgba.push_back(255);
    }
  return picture;
}

// To the nearest of the points of a grid that repeats, two in each picture: middle and corners.
Vector2f from_nearest_middle(const Vector2f& uv, Vector2f& middle) {
  Vector2f best(9.0f, 9.0f);
  for (const Vector2f& at :
       {Vector2f(0.5f, 0.5f), Vector2f(0, 0), Vector2f(1, 0), Vector2f(0, 1), Vector2f(1, 1)})
    if ((uv - at).norm() < best.norm()) {
      best = uv - at;
      middle = at;
    }
  return best;
}

// How much of the drawn colour is at a place, 0 to 1.
float petals(const Vector2f& uv) {
  Vector2f middle;
  const Vector2f d = from_nearest_middle(uv, middle);
  const bool is_turned = middle.x() == 0.5f;
  const float angle = std::atan2(d.y(), d.x()) + (is_turned ? kTwoPi / 10.0f : 0.0f);
  const float size = is_turned ? 0.27f : 0.19f;
  const float edge = size * (0.62f + 0.38f * std::cos(5.0f * angle));
  const float petal = 1.0f - smooth_step(edge - 0.02f, edge + 0.005f, d.norm());
  const float heart = 1.0f - smooth_step(0.035f, 0.05f, d.norm());
  return petal * (1.0f - heart);
}

float dots(const Vector2f& uv) {
  Vector2f middle;
  return 1.0f - smooth_step(0.1f, 0.115f, from_nearest_middle(uv, middle).norm());
}

float stripes(const Vector2f& uv) {
  const float wide = std::abs(std::fmod(4.0f * uv.x(), 1.0f) - 0.5f);
  const float thin = std::abs(std::fmod(4.0f * uv.x() + 0.16f, 1.0f) - 0.5f);
  return std::max(1.0f - smooth_step(0.03f, 0.05f, wide),
                  0.6f * (1.0f - smooth_step(0.012f, 0.03f, thin)));
}

}  // namespace

AvatarPicture cloth_picture(ClothPattern pattern, const Vector3f& ground, const Vector3f& drawn) {
  return drawn_picture(kCloth_px, [&](const Vector2f& uv) {
    float share = 0.0f;
    if (pattern == ClothPattern::kPetals) share = petals(uv);
    if (pattern == ClothPattern::kDots) share = dots(uv);
    if (pattern == ClothPattern::kStripes) share = stripes(uv);
    return Vector3f(ground + share * (drawn - ground));
  });
}

AvatarPicture eye_picture(const Vector3f& iris) {
  return drawn_picture(kEye_px, [&](const Vector2f& uv) {
    constexpr float kIris = 0.235f;  // shares of the picture
    constexpr float kPupil = 0.105f;
    const Vector2f d = uv - Vector2f(0.5f, 0.5f);
    const float r = d.norm();
    const float angle = std::atan2(d.y(), d.x());
    // White, a little darker at the rim, where lids shade it.
    Vector3f colour = Vector3f(0.86f, 0.85f, 0.83f) * (1.0f - 0.5f * smooth_step(0.28f, 0.5f, r));
    const float streaks = 0.5f + 0.5f * std::sin(23.0f * angle + 4.0f * std::sin(7.0f * angle));
    const float depth = smooth_step(kPupil, kIris, r);
    // Light falls in from above and shows at the lower rim of the iris.
    const float glow = smooth_step(-0.05f, 0.2f, d.y());
    Vector3f ring = iris * (0.75f + 0.35f * streaks * (1.0f - depth) + 1.1f * glow);
    ring *= 1.0f - 0.75f * smooth_step(kIris - 0.04f, kIris, r);
    colour += (1.0f - smooth_step(kIris - 0.006f, kIris + 0.006f, r)) * (ring - colour);
    colour *= 1.0f - 0.985f * (1.0f - smooth_step(kPupil - 0.008f, kPupil + 0.008f, r));
    const float light = 1.0f - smooth_step(0.045f, 0.06f, (d - Vector2f(-0.085f, -0.1f)).norm());
    const float small = 1.0f - smooth_step(0.016f, 0.026f, (d - Vector2f(0.1f, 0.09f)).norm());
    return Vector3f(colour + std::max(light, 0.6f * small) * (Vector3f::Ones() - colour));
  });
}

}  // namespace dance

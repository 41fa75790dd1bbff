#include "viewer/overlay/dance_sign.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dance {
namespace {

constexpr ImU32 kShade = IM_COL32(16, 18, 26, 255);
constexpr ImU32 kHeart = IM_COL32(240, 70, 92, 255);
constexpr ImU32 kHands = IM_COL32(255, 209, 102, 255);
constexpr float kSize_em = 2.2f;
constexpr float kRise_em = 0.8f;  // in a second
constexpr float kTag_em = 1.7f;
constexpr float kPop_s = 0.18f;
constexpr float kShrink_s = 0.3f;
constexpr float kClaps_hz = 4.0f;

// Draws in coordinates from −0.5 to 0.5, right and down.
struct SignPen {
  ImDrawList& list;
  ImVec2 centre;
  float size;
  ImU32 colour;
  float wider = 0.0f;  // of the shade

  ImVec2 at(float x, float y) const { return {centre.x + x * size, centre.y + y * size}; }
  void dot(float x, float y, float radius) const {
    list.AddCircleFilled(at(x, y), (radius + wider) * size, colour, 20);
  }
  void line(float x0, float y0, float x1, float y1, float thickness) const {
    list.AddLine(at(x0, y0), at(x1, y1), colour, (thickness + 2.0f * wider) * size);
    dot(x1, y1, 0.5f * thickness);
  }
  void heart() const {
    dot(-0.23f, -0.16f, 0.27f);
    dot(0.23f, -0.16f, 0.27f);
    const float grown = 1.6f * wider;
    list.AddTriangleFilled(at(-0.47f - grown, -0.03f), at(0.47f + grown, -0.03f),
                           at(0.0f, 0.5f + grown), colour);
  }
  // One of two hands that meet in the middle; `side` is −1 or 1.
  void hand(float side, float apart) const {
    const float x = side * (0.13f + apart);
    dot(x, 0.24f, 0.17f);
    for (int finger = 0; finger < 4; ++finger) {
      const float out = side * (0.02f + 0.085f * static_cast<float>(finger));
      const float tip = finger == 0 || finger == 3 ? -0.22f : -0.32f;
      line(x + 0.5f * out, 0.2f, x + 1.3f * out, tip, 0.085f);
    }
    line(x, 0.28f, x - side * 0.1f, 0.0f, 0.085f);
  }
};

void draw_sign(const SignPen& pen, DanceSign sign, float age_s) {
  if (sign == DanceSign::kHeart) return pen.heart();
  const float swing = std::sin(2.0f * std::numbers::pi_v<float> * kClaps_hz * age_s);
  const float apart = 0.06f + 0.06f * swing;
  pen.hand(-1.0f, apart);
  pen.hand(1.0f, apart);
}

float scale_at(float age_s) {
  const float left_s = static_cast<float>(kSignHolds_s) - age_s;
  return std::clamp(std::min(0.3f + 0.7f * age_s / kPop_s, left_s / kShrink_s), 0.0f, 1.0f);
}

}  // namespace

void draw_signs(ImDrawList& list, const SignPicture& picture) {
  for (std::size_t i = 0; i < picture.scene.guests.size(); ++i) {
    const SceneGuest& guest = picture.scene.guests[i];
    if (guest.sign == DanceSign::kNone || guest.hides_head) continue;
    const Eigen::Vector3f anchor_W_m =
        i < picture.tag_anchors_W_m.size() ? picture.tag_anchors_W_m[i] : tag_anchor_W_m(guest);
    const auto at = project(picture.camera, anchor_W_m, picture.width_px, picture.height_px);
    if (!at) continue;
    const float size = kSize_em * picture.em_px * scale_at(guest.sign_age_s);
    const float above = (kTag_em + 0.5f * kSize_em + kRise_em * guest.sign_age_s) * picture.em_px;
    const float y = std::max(at->y_px - above, 0.6f * size);  // all of it in the picture
    SignPen pen{list, {at->x_px, y}, size, kShade, 0.06f};
    draw_sign(pen, guest.sign, guest.sign_age_s);
    pen.colour = guest.sign == DanceSign::kHeart ? kHeart : kHands;
    pen.wider = 0.0f;
    draw_sign(pen, guest.sign, guest.sign_age_s);
  }
}

}  // namespace dance

#include "producers/camera/advice/camera_rules.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

using Measure = std::optional<float>;

// A point that is hidden this near to the edge is beyond it.
constexpr float kNearEdge = 0.04f;
constexpr float kHidden = 0.5f;

// How far a part is outside of the picture, in shares of it.
float outside(const PartInFrame& part) {
  return part.visibility < kHidden ? kNearEdge - part.margin : -part.margin;
}

Measure blackness(const CameraSight& sight) {
  return std::max(sight.facts.light.mean, 0.7f * sight.facts.light.spread);
}
Measure brightness(const CameraSight& sight) { return sight.facts.light.mean; }
Measure white(const CameraSight& sight) { return sight.facts.light.white_share; }
// A bright wall behind a dancer who is well lit does no harm.
Measure light_behind(const CameraSight& sight) {
  constexpr float kWellLit = 0.4f;
  const PictureLight& light = sight.facts.light;
  if (!sight.body.is_found) return std::nullopt;
  return light.body < kWellLit ? light.around - light.body : 0.0f;
}
Measure no_network(const CameraSight& sight) { return sight.has_network ? 0.0f : 1.0f; }
Measure nobody(const CameraSight& sight) {
  if (!sight.has_network) return std::nullopt;
  return sight.body.is_found ? 0.0f : 1.0f;
}
Measure head_outside(const CameraSight& sight) {
  if (!sight.body.is_found) return std::nullopt;
  return outside(sight.body.head);
}
Measure feet_outside(const CameraSight& sight) {
  if (!sight.body.is_found) return std::nullopt;
  return outside(sight.body.feet);
}
Measure hands_outside(const CameraSight& sight) {
  if (!sight.body.is_found) return std::nullopt;
  return -sight.body.hands.margin;
}
// Legs that are in the picture, and that the network does not see.
Measure legs_hidden(const CameraSight& sight) {
  const PartInFrame& knees = sight.body.knees;
  const PartInFrame& feet = sight.body.feet;
  if (!sight.body.is_found || knees.margin < kNearEdge) return std::nullopt;
  const float feet_seen = feet.margin < kNearEdge ? 1.0f : feet.visibility;
  return 1.0f - std::min(knees.visibility, feet_seen);
}
Measure height(const CameraSight& sight) {
  if (!sight.body.is_found) return std::nullopt;
  return sight.body.height;
}
Measure off_the_middle(const CameraSight& sight) {
  if (!sight.body.is_found) return std::nullopt;
  return std::abs(sight.body.centre_x - 0.5f);
}
Measure shake(const CameraSight& sight) { return sight.facts.shake; }
Measure rate(const CameraSight& sight) {
  if (sight.facts.pictures_hz <= 0.0f) return std::nullopt;
  return sight.facts.pictures_hz;
}

constexpr std::array kRules{
    CameraRule{Text::kCameraLensCovered, blackness, 0.06f, 0.09f},
    CameraRule{Text::kCameraTooDark, brightness, 0.14f, 0.18f},
    CameraRule{Text::kCameraTooBright, white, 0.45f, 0.35f},
    CameraRule{Text::kCameraNoNetwork, no_network, 1.0f, 0.0f},
    CameraRule{Text::kCameraNobody, nobody, 1.0f, 0.0f},
    CameraRule{Text::kCameraHeadCutOff, head_outside, 0.0f, -0.015f},
    CameraRule{Text::kCameraFeetCutOff, feet_outside, 0.0f, -0.015f},
    CameraRule{Text::kCameraLegsHidden, legs_hidden, 0.6f, 0.4f},
    CameraRule{Text::kCameraStepToMiddle, off_the_middle, 0.33f, 0.27f},
    CameraRule{Text::kCameraComeCloser, height, 0.33f, 0.38f},
    CameraRule{Text::kCameraBackLight, light_behind, 0.35f, 0.28f},
    CameraRule{Text::kCameraShakes, shake, 0.012f, 0.006f},
    CameraRule{Text::kCameraSlow, rate, 18.0f, 21.0f},
    CameraRule{Text::kCameraHandsCutOff, hands_outside, 0.0f, -0.02f},
};

}  // namespace

std::span<const CameraRule, kCameraRules> camera_rules() { return kRules; }

}  // namespace dance

#include "headset/panel/wrist_panel.h"

#include <algorithm>
#include <cmath>

namespace dance {

using Eigen::Isometry3f;
using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

// It shows while its face is turned to the eyes, near enough to be read; a turn of the hand in the
// dance does not show it.
constexpr float kShows_cos = 0.82f, kHides_cos = 0.70f;
constexpr float kLooksAt_cos = 0.90f, kLooksAway_cos = 0.77f;
constexpr Duration kLooksFor = Duration::ms(250);
constexpr float kFarthest_m = 0.75f;
constexpr float kFade_s = 0.15f;
constexpr float kTouch_m = 0.012f;  // before the panel, and as far again behind it
constexpr float kNear_m = 0.05f, kBehind_m = 0.05f;
constexpr float kLongestRay_m = 1.5f;
constexpr Duration kHoldToLeave = Duration::ms(900);

// Two rows of two buttons under the lines of the head.
constexpr float kTop = 0.42f, kGap = 0.03f;

}  // namespace

PanelArea WristPanel::area_of(PanelAction action) {
  const auto i = static_cast<std::size_t>(action);
  const float width = (1.0f - 3.0f * kGap) / 2.0f;
  const float height = (1.0f - kTop - 2.0f * kGap) / 2.0f;
  const float u = kGap + static_cast<float>(i % 2) * (width + kGap);
  const float v = kTop + static_cast<float>(i / 2) * (height + kGap);
  return {u, v, u + width, v + height};
}

void WristPanel::place(const Input& input) {
  const Isometry3f& grip = *input.left_grip_W;
  // Of a left hand the back is at -X, the little finger at +Z, the fingers at -Y.
  const Vector3f to_eyes = -grip.linear().col(0);
  board_.axes_W.col(2) = to_eyes;
  board_.axes_W.col(1) = grip.linear().col(2);
  board_.axes_W.col(0) = -grip.linear().col(1);
  board_.centre_W_m =
      grip.translation() + kOverBack_m * to_eyes - kTowardsFingers_m * grip.linear().col(1);
}

// Turned to the eyes, and in the middle of what they see: a hand on a partner's shoulder is not.
bool WristPanel::is_looked_at(const Input& input) const {
  const Vector3f to_eyes = input.eyes_W_m - board_.centre_W_m;
  const float distance = to_eyes.norm();
  if (distance > kFarthest_m || distance < 1e-3f) return false;
  const bool is_shown = opacity_ > 0.0f;
  const float cosine = to_eyes.dot(board_.axes_W.col(2)) / distance;
  const float ahead = -to_eyes.dot(input.looks_W) / distance;
  return cosine > (is_shown ? kHides_cos : kShows_cos) &&
         ahead > (is_shown ? kLooksAway_cos : kLooksAt_cos);
}

std::optional<Vector2f> WristPanel::place_on(const Vector3f& at_W_m) const {
  const Vector3f off = at_W_m - board_.centre_W_m;
  const Vector2f on(0.5f + off.dot(board_.axes_W.col(0)) / kWidth_m,
                    0.5f - off.dot(board_.axes_W.col(1)) / kHeight_m);
  if ((on.array() < 0.0f).any() || (on.array() > 1.0f).any()) return std::nullopt;
  return on;
}

std::optional<Vector2f> WristPanel::point_at(const Input& input, bool& presses) const {
  presses = input.is_pressed;
  if (input.fingertip_W_m) {
    const float before = board_.axes_W.col(2).dot(*input.fingertip_W_m - board_.centre_W_m);
    if (before < kNear_m) {
      // Behind it too, so that one that went through does not press again on its way back.
      presses = before < kTouch_m;
      return before < -kBehind_m ? std::nullopt : place_on(*input.fingertip_W_m);
    }
  }
  if (!input.right_aim_W) return std::nullopt;
  const Vector3f normal = board_.axes_W.col(2);
  const Vector3f from = input.right_aim_W->translation();
  const Vector3f along = -input.right_aim_W->linear().col(2);
  const float towards = -normal.dot(along);
  if (towards < 0.05f) return std::nullopt;
  const float distance = normal.dot(from - board_.centre_W_m) / towards;
  if (distance < 0.0f || distance > kLongestRay_m) return std::nullopt;
  return place_on(from + distance * along);
}

float WristPanel::held(PanelAction action) const { return holding_ == action ? held_ : 0.0f; }

std::optional<PanelAction> WristPanel::update(const Input& input, MonoTime now) {
  const float dt_s = last_.is_set() ? static_cast<float>((now - last_).as_seconds()) : 0.0f;
  last_ = now;
  if (input.menu_pressed && !was_menu_) is_open_ = !is_open_;
  was_menu_ = input.menu_pressed;
  if (input.left_grip_W) place(input);
  if (!input.left_grip_W || !is_looked_at(input))
    looked_since_ = MonoTime();
  else if (!looked_since_.is_set())
    looked_since_ = now;
  const bool is_meant = looked_since_.is_set() && now - looked_since_ >= kLooksFor;
  const bool shows = input.left_grip_W && (is_open_ || is_meant);
  const float step = std::clamp(dt_s, 0.0f, kFade_s) / kFade_s;
  opacity_ = std::clamp(opacity_ + (shows ? step : -step), 0.0f, 1.0f);

  // A press begins on the panel: one that is held when it appears is none.
  bool presses = false;
  const auto pointed = point_at(input, presses);
  pointer_ = shows && opacity_ > 0.5f ? pointed : std::nullopt;
  hovered_.reset();
  for (std::size_t i = 0; pointer_ && i < kPanelActions; ++i)
    if (area_of(static_cast<PanelAction>(i)).has(pointer_->x(), pointer_->y()))
      hovered_ = static_cast<PanelAction>(i);
  const bool begins = presses && !was_pressed_;
  was_pressed_ = presses;
  if (!presses || hovered_ != holding_) holding_.reset(), held_ = 0.0f;
  if (!hovered_ || !presses) return std::nullopt;
  if (*hovered_ != PanelAction::kLeave) return begins ? hovered_ : std::nullopt;
  if (begins) holding_ = hovered_, holding_since_ = now;
  if (!holding_) return std::nullopt;
  held_ = static_cast<float>((now - holding_since_).as_seconds() / kHoldToLeave.as_seconds());
  if (held_ < 1.0f) return std::nullopt;
  holding_.reset();
  held_ = 0.0f;
  return PanelAction::kLeave;
}

}  // namespace dance

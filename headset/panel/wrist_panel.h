// WristPanel: the small panel over the back of the left hand: when it shows, where it is, which of
// its buttons the other hand points at or touches, and which were pressed.
//
// Units/frames: metres in W; on the panel u runs to the right and v down, 0 to 1.
// Ownership:    plain values; never allocates.
// Threads:      none inside; the drawing thread owns it.
// Failure:      none: without a left hand it is hidden.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "core/base/time.h"

namespace dance {

enum class PanelAction : std::uint8_t { kMute, kRecentre, kCalibrate, kLeave };
constexpr std::size_t kPanelActions = 4;

struct PanelBoard {
  Eigen::Vector3f centre_W_m = Eigen::Vector3f::Zero();
  Eigen::Matrix3f axes_W = Eigen::Matrix3f::Identity();  // right, up, towards the eyes
};

// A box on the panel.
struct PanelArea {
  float u0, v0, u1, v1;

  bool has(float u, float v) const { return u >= u0 && u < u1 && v >= v0 && v < v1; }
};

class WristPanel {
 public:
  static constexpr float kWidth_m = 0.20f, kHeight_m = 0.14f;
  // Of its middle, from the palm: out of the back of the hand, and towards the fingers, so that the
  // own forearm is not before it.
  static constexpr float kOverBack_m = 0.09f, kTowardsFingers_m = 0.02f;

  struct Input {
    Eigen::Vector3f eyes_W_m = Eigen::Vector3f::Zero();
    Eigen::Vector3f looks_W = -Eigen::Vector3f::UnitZ();  // straight ahead of the head
    // OpenXR's grip pose of the left hand.
    std::optional<Eigen::Isometry3f> left_grip_W;
    // The right hand: a ray that it points along (-Z of its aim pose) …
    std::optional<Eigen::Isometry3f> right_aim_W;
    bool is_pressed = false;
    // … or, near the panel, the tip of a bare forefinger, which presses by touching.
    std::optional<Eigen::Vector3f> fingertip_W_m;
    bool menu_pressed = false;  // shows it wherever the hand is, and hides it again
  };

  // The action that was pressed in this picture.
  std::optional<PanelAction> update(const Input& input, MonoTime now);

  float opacity() const { return opacity_; }
  const PanelBoard& board() const { return board_; }
  std::optional<PanelAction> hovered() const { return hovered_; }
  // Where it is pointed at, on the panel.
  std::optional<Eigen::Vector2f> pointer() const { return pointer_; }
  // How much of the time that this button must be held is over, 0 to 1: leaving is not done by
  // chance.
  float held(PanelAction action) const;

  static PanelArea area_of(PanelAction action);

 private:
  void place(const Input& input);
  bool is_looked_at(const Input& input) const;
  std::optional<Eigen::Vector2f> point_at(const Input& input, bool& presses) const;
  std::optional<Eigen::Vector2f> place_on(const Eigen::Vector3f& at_W_m) const;

  PanelBoard board_;
  float opacity_ = 0.0f;
  bool is_open_ = false, was_menu_ = false, was_pressed_ = false;
  std::optional<PanelAction> hovered_;
  std::optional<Eigen::Vector2f> pointer_;
  std::optional<PanelAction> holding_;
  MonoTime holding_since_, last_;
  MonoTime looked_since_;  // not set: not looked at
  float held_ = 0.0f;
};

}  // namespace dance

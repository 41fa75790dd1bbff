// Where a scripted dancer holds both hands to look at the panel at the left wrist and to point at
// its buttons, as lines for the test runtime.
//
// Units/frames: metres in the runtime's stage; the head looks along -Z.
// Ownership:    plain values.
// Threads:      any.
// Failure:      none.
#pragma once

#include <Eigen/Geometry>
#include <numbers>
#include <string>

#include "headset/panel/wrist_panel.h"

namespace dance {

class ScriptedHands {
 public:
  // The panel is 40 cm before these eyes, upright and facing them.
  explicit ScriptedHands(const Eigen::Vector3f& eyes_m)
      : panel_m_(eyes_m + Eigen::Vector3f(0.0f, 0.0f, -0.4f)) {}

  // The grip whose back (-X) is towards +Z and whose thumb's opposite (+Z) is up.
  std::string left_at(double time_s) const {
    Eigen::Matrix3f R;
    R.col(0) = -Eigen::Vector3f::UnitZ();
    R.col(1) = -Eigen::Vector3f::UnitX();
    R.col(2) = Eigen::Vector3f::UnitY();
    return line(
        time_s, "left-hand",
        panel_m_ - Eigen::Vector3f(WristPanel::kTowardsFingers_m, 0.0f, WristPanel::kOverBack_m),
        Eigen::Quaternionf(R));
  }
  // The grip of a controller that points at the middle of that button.
  std::string right_at(double time_s, PanelAction action) const {
    const PanelArea area = WristPanel::area_of(action);
    const float u = 0.5f * (area.u0 + area.u1), v = 0.5f * (area.v0 + area.v1);
    const Eigen::Vector3f button =
        panel_m_ + Eigen::Vector3f((u - 0.5f) * WristPanel::kWidth_m,
                                   (0.5f - v) * WristPanel::kHeight_m, 0.0f);
    const Eigen::Vector3f from = panel_m_ + Eigen::Vector3f(0.25f, -0.3f, 0.3f);
    Eigen::Isometry3f aim = Eigen::Isometry3f::Identity();
    aim.translation() = from;
    aim.linear() =
        Eigen::Quaternionf::FromTwoVectors(-Eigen::Vector3f::UnitZ(), button - from).matrix();
    // As the test runtime has it: the ray leaves the upper end of the handle, which leans.
    Eigen::Isometry3f aim_in_grip = Eigen::Isometry3f::Identity();
    aim_in_grip.translate(Eigen::Vector3f(0.0f, 0.02f, -0.06f))
        .rotate(Eigen::AngleAxisf(-0.25f * std::numbers::pi_v<float>, Eigen::Vector3f::UnitX()));
    const Eigen::Isometry3f grip = aim * aim_in_grip.inverse();
    return line(time_s, "right-hand", grip.translation(), Eigen::Quaternionf(grip.linear()));
  }
  static std::string line(double time_s, const char* point, const Eigen::Vector3f& p_m,
                          const Eigen::Quaternionf& R) {
    std::string text = "at " + std::to_string(time_s) + " pose " + point;
    for (const float x : {p_m.x(), p_m.y(), p_m.z(), R.x(), R.y(), R.z(), R.w()})
      text += " " + std::to_string(x);
    return text + "\n";
  }

 private:
  Eigen::Vector3f panel_m_;
};

}  // namespace dance

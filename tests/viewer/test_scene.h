// Scenes made by hand for the viewer's tests: T-poses, a couple in dance hold, a full floor.
//
// Units/frames: metres in W.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "core/pose/kinematics.h"
#include "viewer/scene/scene.h"

namespace dance {

inline SceneGuest guest_in_t_pose(const char* name) {
  SceneGuest guest;
  guest.id = *GuestId::parse(name);
  guest.pose.p_WH_m = Eigen::Vector3f(0.0f, guest.skeleton.hips_height_m(), 0.0f);
  return guest;
}

// Stands at ease at `place`, turned by yaw about the vertical (0 faces +Z).
inline SceneGuest guest_at_ease(const char* name, const Eigen::Vector3f& place, float yaw_rad,
                                float height_m = 1.72f) {
  SceneGuest guest = guest_in_t_pose(name);
  guest.skeleton = average_skeleton(height_m);
  const Eigen::Quaternionf R_WY(Eigen::AngleAxisf(yaw_rad, Eigen::Vector3f::UnitY()));
  guest.pose.R_PB[0] = R_WY;
  guest.pose.p_WH_m = place + Eigen::Vector3f(0.0f, guest.skeleton.hips_height_m() - 0.02f, 0.0f);
  for (const auto& [limb, side] : {std::pair{kLeftArm, 1.0f}, std::pair{kRightArm, -1.0f}}) {
    BodyFrames frames;
    forward_kinematics(guest.skeleton, guest.pose, frames);
    const Eigen::Vector3f wrist =
        frames.position(limb.upper) + R_WY * Eigen::Vector3f(side * 0.09f, -0.49f, 0.08f);
    const Eigen::Quaternionf R_WHand =
        R_WY * Eigen::AngleAxisf(-side * 1.45f, Eigen::Vector3f::UnitZ());
    solve_two_bone(guest.skeleton, limb, wrist, R_WY * Eigen::Vector3f(side * 0.5f, 0, -1), R_WHand,
                   guest.pose, frames);
  }
  return guest;
}

// Two partners who face each other along X, hands in hold, she in a side step.
inline SceneState couple() {
  SceneState scene;
  for (const float side : {1.0f, -1.0f}) {
    SceneGuest guest =
        guest_at_ease(side > 0 ? "alice" : "bob", Eigen::Vector3f(side * 0.42f, 0.0f, 0.0f),
                      -side * 0.5f * std::numbers::pi_v<float>, side > 0 ? 1.66f : 1.8f);
    const Eigen::Quaternionf R_WY = guest.pose.R_PB[0];
    const Eigen::Vector3f place(side * 0.42f, 0.0f, 0.0f);
    guest.pose.p_WH_m.y() -= 0.03f;
    guest.pose.R_PB[0] = R_WY * Eigen::AngleAxisf(0.12f * side, Eigen::Vector3f::UnitZ()) *
                         Eigen::AngleAxisf(0.1f, Eigen::Vector3f::UnitY());
    guest.pose.R_PB[index_of(Bone::kSpine)] =
        Eigen::AngleAxisf(-0.12f * side, Eigen::Vector3f::UnitZ());
    BodyFrames frames;
    forward_kinematics(guest.skeleton, guest.pose, frames);
    const float ankle = 0.08f * standing_height_m(guest.skeleton) / 1.72f;
    const Eigen::Vector3f pole = R_WY * Eigen::Vector3f::UnitZ();
    solve_two_bone(guest.skeleton, kLeftLeg,
                   place + R_WY * Eigen::Vector3f(0.1f, ankle, side > 0 ? 0.12f : -0.16f), pole,
                   R_WY, guest.pose, frames);
    forward_kinematics(guest.skeleton, guest.pose, frames);
    solve_two_bone(guest.skeleton, kRightLeg,
                   place + R_WY * Eigen::Vector3f(-0.1f, ankle, side > 0 ? -0.2f : 0.08f), pole,
                   R_WY, guest.pose, frames);
    forward_kinematics(guest.skeleton, guest.pose, frames);
    // The raised hands meet on the side of +Z; the others at the partner's back and shoulder.
    const Eigen::Vector3f raised(side * 0.03f, 1.42f, 0.46f);
    const Eigen::Vector3f other =
        side > 0 ? Eigen::Vector3f(-0.36f, 1.42f, -0.22f) : Eigen::Vector3f(0.36f, 1.16f, -0.18f);
    const Limb& near_limb = side > 0 ? kRightArm : kLeftArm;
    const Limb& far_limb = side > 0 ? kLeftArm : kRightArm;
    solve_two_bone(guest.skeleton, near_limb, raised, Eigen::Vector3f(side, -1.0f, 0.3f),
                   R_WY * Eigen::AngleAxisf(side * -0.9f, Eigen::Vector3f::UnitZ()), guest.pose,
                   frames);
    forward_kinematics(guest.skeleton, guest.pose, frames);
    solve_two_bone(guest.skeleton, far_limb, other, Eigen::Vector3f(side, -1.0f, -0.6f),
                   R_WY * Eigen::AngleAxisf(side * -1.2f, Eigen::Vector3f::UnitY()), guest.pose,
                   frames);
    guest.figures = {60.0f, side > 0 ? 0.8f : 23.4f, side > 0 ? 0.0f : 0.2f};
    scene.guests.push_back(guest);
  }
  return scene;
}

// Thirty guests at ease, in six rows of five, 1.1 m apart.
inline SceneState full_floor() {
  SceneState scene;
  for (int i = 0; i < 30; ++i) {
    const std::string name = "guest-" + std::to_string(i);
    const Eigen::Vector3f place(1.1f * static_cast<float>(i % 6 - 2) - 0.55f, 0.0f,
                                1.1f * static_cast<float>(i / 6 - 2));
    scene.guests.push_back(guest_at_ease(name.c_str(), place, 0.0f));
  }
  return scene;
}

}  // namespace dance

#include "transformers/style/scaled_steps.h"

#include <algorithm>
#include <cmath>

#include "core/base/smooth_step.h"
#include "core/motion/saturated.h"
#include "core/pose/heading.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

// A leg's end is moved by its scaled turns, and hips over their feet, by this at most.
constexpr float kMostSwing_m = 0.3f;
constexpr float kMostHips_m = 0.3f;
// A foot on its way comes to its place so fast, and takes so much of the hips' way back.
constexpr float kSetDownPerSecond = 120.0f;
constexpr float kComeBack_s = 0.2f;
// … when legs are as danced again, so slowly that it is seen as a step.
constexpr float kGoHomePerSecond = 12.0f;
constexpr float kFootFastest_m_s = 3.0f;
// A foot in the air carries so little: hips hang between two feet that both swing.
constexpr float kLeastCarried = 0.02f;
// Hips are heavy: they come to their place in this time, and no faster than that.
constexpr float kHipsCome_s = 0.03f;
constexpr float kHipsFastest_m_s = 2.0f;
// A heel so high is free to turn about its ball, and to lift higher.
constexpr float kHeelIsUp_m = 0.015f;
constexpr float kAlmost_m = 1e-3f;
// Feet that stand closer than this to where they were danced stand there.
constexpr float kHome_m = 1e-3f, kHome_rad = 2e-3f;

Vector3f no_longer_than(float most, const Vector3f& v) {
  const float size = v.norm();
  return size > most ? Vector3f(most / size * v) : v;
}

// What the scaled leg moves its ball by, and turns its foot by.
Vector3f leg_moves_m(std::size_t side, const BodyFrames& danced, const BodyFrames& scaled) {
  const std::size_t ball = ball_of(side);
  return saturated(scaled.p_WB_m[ball] - danced.p_WB_m[ball], kMostSwing_m);
}

Quaternionf leg_turns(std::size_t side, const BodyFrames& danced, const BodyFrames& scaled) {
  const std::size_t ankle = ankle_of(side);
  return scaled.R_WB[ankle] * danced.R_WB[ankle].conjugate();
}

// How free a foot is to turn: 0 flat on the floor … 1 with its heel up, or on its way.
float leaves_floor(const SwingFeet& feet, std::size_t side, const BodyFrames& danced) {
  return std::max(feet.swing(side), smooth_step(feet.heel_m(side, danced) / kHeelIsUp_m));
}

}  // namespace

Vector3f ScaledSteps::hips_wanted_m(const SwingFeet& feet, const BodyFrames& danced,
                                    const BodyFrames& scaled) const {
  Vector3f sum = Vector3f::Zero();
  float carried = 0.0f;
  for (std::size_t side = 0; side < kSwingLegs.size(); ++side) {
    const float carries = 1.0f - feet.swing(side) + kLeastCarried;
    sum += carries * (feet_[side].moved_m - leg_moves_m(side, danced, scaled));
    carried += carries;
  }
  Vector3f moved = sum / carried;
  // Nobody is pressed down in the air.
  moved.y() *= std::min(1.0f, carried);
  return saturated(moved, kMostHips_m);
}

void ScaledSteps::follow(const SwingFeet& feet, const BodyFrames& danced, const BodyFrames& scaled,
                         float dt_s, bool goes_home) {
  const Vector3f wanted = hips_wanted_m(feet, danced, scaled) - hips_moved_m_;
  const Vector3f hips_step = (1.0f - std::exp(-dt_s / kHipsCome_s)) * wanted;
  hips_moved_m_ += no_longer_than(kHipsFastest_m_s * dt_s, hips_step);
  is_home_ = hips_moved_m_.norm() < kHome_m;
  for (std::size_t side = 0; side < kSwingLegs.size(); ++side) {
    Foot& foot = feet_[side];
    const float swing = feet.swing(side);
    const float per_s = goes_home ? kGoHomePerSecond : kSetDownPerSecond;
    const auto coming = [&](float free) { return 1.0f - std::exp(-per_s * free * dt_s); };
    Vector3f target = Vector3f::Zero();
    float turned_rad = 0.0f;
    if (!goes_home) {
      target = leg_moves_m(side, danced, scaled) + hips_moved_m_;
      turned_rad = heading_rad(leg_turns(side, danced, scaled));
    }
    Vector3f change = coming(swing) * (target - foot.moved_m);
    if (!goes_home) change -= std::min(1.0f, swing * swing * dt_s / kComeBack_s) * hips_moved_m_;
    change.y() = 0.0f;
    foot.moved_m += no_longer_than(kFootFastest_m_s * dt_s, change);
    foot.turned_rad += coming(leaves_floor(feet, side, danced)) * (turned_rad - foot.turned_rad);
    is_home_ = is_home_ && foot.moved_m.norm() < kHome_m && std::abs(foot.turned_rad) < kHome_rad;
  }
}

ScaledSteps::Aim ScaledSteps::aim(const SwingFeet& feet, const BodyFrames& danced,
                                  const BodyFrames& scaled) const {
  Aim out;
  out.hips_moved_m = hips_moved_m_;
  for (std::size_t side = 0; side < kSwingLegs.size(); ++side) {
    const Foot& foot = feet_[side];
    const std::size_t ankle = ankle_of(side), ball = ball_of(side);
    const Vector3f ankle_to_ball =
        danced.R_WB[ankle].conjugate() * (danced.p_WB_m[ball] - danced.p_WB_m[ankle]);
    Vector3f place = danced.p_WB_m[ball] + foot.moved_m;
    place.y() += feet.swing(side) * (leg_moves_m(side, danced, scaled).y() + out.hips_moved_m.y());
    place.y() = std::max(place.y(), feet.lowest_ball_m(side, danced));
    const Quaternionf turns = leg_turns(side, danced, scaled);
    const Quaternionf tilts = about_up(-heading_rad(turns)) * turns;
    const float floor_m = feet.lowest_ankle_m(side, danced);
    const Quaternionf flat = about_up(foot.turned_rad);
    // The foot on its ball, tilted by a part of what its leg tilts it by.
    const auto set_down = [&](float tilt) {
      out.R_WFoot[side] = flat * Quaternionf::Identity().slerp(tilt, tilts) * danced.R_WB[ankle];
      out.p_WAnkle_m[side] = place - out.R_WFoot[side] * ankle_to_ball;
      return out.p_WAnkle_m[side].y();
    };
    // The floor takes as much of the tilt as would bring the heel below it.
    const float most_tilt = leaves_floor(feet, side, danced);
    const float untilted = set_down(0.0f), tilted = set_down(most_tilt);
    const float too_low = std::max(0.0f, floor_m - tilted) - std::max(0.0f, floor_m - untilted);
    if (too_low > 0.0f) set_down(most_tilt * (1.0f - too_low / (untilted - tilted + kAlmost_m)));
    out.p_WAnkle_m[side].y() = std::max(out.p_WAnkle_m[side].y(), floor_m);
    // Toes that stand lie as they lay.
    out.R_WToes[side] = (flat * danced.R_WB[ball]).slerp(feet.swing(side), scaled.R_WB[ball]);
  }
  return out;
}

}  // namespace dance

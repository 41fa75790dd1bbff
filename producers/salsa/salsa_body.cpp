#include "producers/salsa/salsa_body.h"

#include <cmath>

#include "producers/salsa/salsa_ease.h"

namespace dance {
namespace {

using Eigen::AngleAxisf;
using Eigen::Quaternionf;
using Eigen::Vector3f;
using salsa::ease;
using salsa::flow;
using salsa::radians;

Quaternionf about_x(double rad) {
  return Quaternionf(AngleAxisf(static_cast<float>(rad), Vector3f::UnitX()));
}
Quaternionf about_y(double rad) {
  return Quaternionf(AngleAxisf(static_cast<float>(rad), Vector3f::UnitY()));
}
Quaternionf about_z(double rad) {
  return Quaternionf(AngleAxisf(static_cast<float>(rad), Vector3f::UnitZ()));
}

Vector3f forward(double yaw_rad) {
  return {static_cast<float>(std::sin(yaw_rad)), 0.0f, static_cast<float>(std::cos(yaw_rad))};
}

// Body, sway and hold as flows over the counts. The hips arrive after the foot: their delays are
// what makes a step a weight transfer.
FloorPlace body_at(const SalsaCounts& counts, double beats) {
  return flow(beats, 1.5, 0.12, [&](std::int64_t n) { return counts.at(n).body; });
}
double sway_at(const SalsaCounts& counts, double beats) {
  return flow(beats, 1.0, 0.30, [&](std::int64_t n) { return counts.at(n).sway; });
}
// The hip follows its foot, then settles back as the leg takes the weight.
double hip_turn_at(const SalsaCounts& counts, double beats) {
  const double with_foot =
      flow(beats, 1.0, 0.0, [&](std::int64_t n) { return counts.at(n).hip_turn_rad; });
  return with_foot + radians(5.0) * sway_at(counts, beats - 0.2);
}

// How much of a stance's turning the foot does: none for small angles, which the hip joint takes,
// all of what goes beyond.
double pivot(double angle_rad) {
  constexpr double kHipTakes_rad = 0.75;
  return angle_rad - kHipTakes_rad * std::tanh(angle_rad / kHipTakes_rad);
}

struct Landing {
  std::int64_t n;
  const SalsaCount& count;
};

Landing landing_near(const SalsaCounts& counts, bool is_left, std::int64_t n, int direction) {
  while (!(counts.at(n).is_step && counts.at(n).is_left == is_left)) n += direction;
  return {n, counts.at(n)};
}

double stance_yaw(const SalsaCounts& counts, const SalsaCount& landing, double beats) {
  const double foot = landing.foot.yaw_rad;
  const double turn_out = foot - landing.body.yaw_rad;
  return foot + pivot(body_at(counts, beats).yaw_rad + turn_out - foot);
}

float ball_height_m(const Skeleton& skeleton) {
  return skeleton.hips_height_m() + skeleton.offset(Bone::kLeftUpperLeg).y() +
         skeleton.offset(Bone::kLeftLowerLeg).y() + skeleton.offset(Bone::kLeftFoot).y() +
         skeleton.offset(Bone::kLeftToes).y();
}

// The hips' height at which neither leg is stretched over kStretch of its length: a soft minimum of
// what each leg allows and of how high this dancer stands.
double hips_height(const Skeleton& skeleton, const Pose& pose,
                   const std::array<Vector3f, 2>& ankles_W_m, double wanted_m) {
  constexpr double kStretch = 0.988;
  constexpr double kSharpness_per_m = 130.0;
  constexpr std::array<Limb, 2> kLegs{kLeftLeg, kRightLeg};
  double sum = std::exp(-kSharpness_per_m * wanted_m);
  for (std::size_t i = 0; i < 2; ++i) {
    const Vector3f hip = pose.R_PB[0] * skeleton.offset(kLegs[i].upper);
    const double leg = kStretch * static_cast<double>(skeleton.offset(kLegs[i].lower).norm() +
                                                      skeleton.offset(kLegs[i].end).norm());
    const double dx = static_cast<double>(pose.p_WH_m.x() + hip.x() - ankles_W_m[i].x());
    const double dz = static_cast<double>(pose.p_WH_m.z() + hip.z() - ankles_W_m[i].z());
    const double up = std::sqrt(std::max(0.01, leg * leg - dx * dx - dz * dz));
    const double allowed = static_cast<double>(ankles_W_m[i].y() - hip.y()) + up;
    sum += std::exp(-kSharpness_per_m * allowed);
  }
  return -std::log(sum) / kSharpness_per_m;
}

void pose_spine(const SalsaCounts& counts, double beats, double delay_beats, double energy,
                Pose& pose) {
  const double late = beats - delay_beats;
  const double sway = sway_at(counts, late);
  // The chest keeps towards the partner while the hips turn under it, and leans a little against
  // the roll of the pelvis: ribs over the standing leg, shoulders nearly level.
  const double yaw = body_at(counts, beats - 0.5 * delay_beats).yaw_rad -
                     0.45 * energy * hip_turn_at(counts, late);
  const double roll = -radians(2.6) * energy * sway;
  const double pitch =
      radians(2.5) + radians(0.8) * energy * std::cos(2.0 * salsa::kPi * (late - 0.15));
  const Quaternionf R_WC = about_y(yaw) * about_z(roll) * about_x(pitch);
  Quaternionf R_HC = pose.R_PB[0].conjugate() * R_WC;
  if (R_HC.w() < 0.0f) R_HC.coeffs() = -R_HC.coeffs();
  // A third in each bone: all three turn about the same axis.
  const Quaternionf third = Quaternionf::Identity().slerp(1.0f / 3.0f, R_HC);
  pose.R_PB[index_of(Bone::kSpine)] = third;
  pose.R_PB[index_of(Bone::kChest)] = third;
  pose.R_PB[index_of(Bone::kUpperChest)] = third;
}

}  // namespace

SalsaFoot salsa_foot(const SalsaCounts& counts, const Skeleton& skeleton, bool is_left,
                     double beats) {
  const auto now = static_cast<std::int64_t>(std::floor(beats));
  const Landing last = landing_near(counts, is_left, now, -1);
  const Landing next = landing_near(counts, is_left, now + 1, 1);
  const Landing relief = landing_near(counts, !is_left, last.n + 1, 1);  // takes its weight
  const auto since = [&](std::int64_t n) { return beats - static_cast<double>(n); };
  // After a pause there is more time for the way.
  const bool has_time = !counts.at(next.n - 1).is_step;
  const double swing_beats = has_time ? kSalsaSlowSwing_beats : kSalsaSwing_beats;
  const double swing = since(next.n) / swing_beats + 1.0;
  const double way = ease(swing);
  const double distance_m = std::hypot(next.count.foot.x_m - last.count.foot.x_m,
                                       next.count.foot.z_m - last.count.foot.z_m);
  const double lift_m = std::min(0.07, 0.024 + 0.09 * distance_m) * salsa::hill(swing);

  SalsaFoot foot;
  foot.is_planted = swing <= 0.0;
  foot.p_WBall_m = {static_cast<float>(std::lerp(last.count.foot.x_m, next.count.foot.x_m, way)),
                    ball_height_m(skeleton) + static_cast<float>(lift_m),
                    static_cast<float>(std::lerp(last.count.foot.z_m, next.count.foot.z_m, way))};
  foot.yaw_rad = stance_yaw(counts, last.count, beats);
  if (swing > 0.0)
    foot.yaw_rad = std::lerp(foot.yaw_rad, stance_yaw(counts, next.count, beats), way);

  // Ball first: the heel comes down after landing, peels off when the other foot takes over, and
  // is on its way down when the foot lands again.
  const double lowering = 1.0 - ease(since(last.n) / 0.45);
  const double peeling = ease((since(relief.n) + 0.25) / 0.85);
  const double peel_rad = 0.50 + 0.35 * ease((distance_m - 0.15) / 0.4);  // long steps push off
  // It rises as well where the body goes on ahead of the foot.
  const FloorPlace body = body_at(counts, beats);
  const double ahead_m =
      (body.x_m - static_cast<double>(foot.p_WBall_m.x())) * std::sin(foot.yaw_rad) +
      (body.z_m - static_cast<double>(foot.p_WBall_m.z())) * std::cos(foot.yaw_rad);
  constexpr double kSoft_m = 0.025;
  const double carried_rad = 3.0 * kSoft_m * std::log1p(std::exp((ahead_m + 0.02) / kSoft_m));
  const double heel_rad = last.count.heel_rad * lowering + peel_rad * peeling * (1.0 - way) +
                          next.count.heel_rad * way + carried_rad;
  foot.heel_rad = std::tanh(heel_rad);
  return foot;
}

SalsaHold salsa_hold(const SalsaCounts& counts, double beats) {
  return flow(beats, 1.7, -0.35, [&](std::int64_t n) { return counts.at(n).hold; });
}

void pose_salsa_body(const SalsaCounts& counts, const Skeleton& skeleton, double beats,
                     double delay_beats, double energy, SalsaBody& body) {
  Pose& pose = body.pose;
  pose.R_PB = identity_rotations();
  body.hold = salsa_hold(counts, beats);
  body.sway = sway_at(counts, beats);

  // Cuban motion: the hip of the standing leg goes out and up, the other sinks over a bent knee.
  const FloorPlace place = body_at(counts, beats);
  const double turn = energy * hip_turn_at(counts, beats);
  pose.R_PB[0] = about_y(place.yaw_rad + turn) * about_z(radians(6.5) * energy * body.sway) *
                 about_x(radians(2.0));
  const double side_m = 0.042 * (0.4 + 0.6 * energy) * body.sway;
  pose.p_WH_m.x() = static_cast<float>(place.x_m + side_m * std::cos(place.yaw_rad));
  pose.p_WH_m.z() = static_cast<float>(place.z_m - side_m * std::sin(place.yaw_rad));

  std::array<Quaternionf, 2> R_WFoot;
  std::array<Vector3f, 2> ankles_W_m;
  for (std::size_t i = 0; i < 2; ++i) {
    body.feet[i] = salsa_foot(counts, skeleton, i == 0, beats);
    R_WFoot[i] = about_y(body.feet[i].yaw_rad) * about_x(body.feet[i].heel_rad);
    const Bone toes = i == 0 ? Bone::kLeftToes : Bone::kRightToes;
    ankles_W_m[i] = body.feet[i].p_WBall_m - R_WFoot[i] * skeleton.offset(toes);
    pose.R_PB[index_of(toes)] = about_x(-body.feet[i].heel_rad);
  }
  const double drop = flow(beats, 1.4, 0.1, [&](std::int64_t n) { return counts.at(n).drop_m; });
  const double bounce = 0.006 * energy * std::cos(2.0 * salsa::kPi * (beats - 0.08));
  const double wanted = static_cast<double>(skeleton.hips_height_m()) - 0.006 - drop - bounce;
  pose.p_WH_m.y() = static_cast<float>(hips_height(skeleton, pose, ankles_W_m, wanted));

  pose_spine(counts, beats, delay_beats, energy, pose);
  forward_kinematics(skeleton, pose, body.frames);
  for (std::size_t i = 0; i < 2; ++i) {
    // Knees go where the toes point, as far as the pelvis lets them.
    const Vector3f knee =
        0.65f * forward(body.feet[i].yaw_rad) + 0.35f * forward(place.yaw_rad + turn);
    solve_two_bone(skeleton, i == 0 ? kLeftLeg : kRightLeg, ankles_W_m[i], knee, R_WFoot[i], pose,
                   body.frames);
  }
}

}  // namespace dance

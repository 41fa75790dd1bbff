#include "research/predict/couple_takes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/motion/palm_pull.h"
#include "core/pose/shortest_turn.h"
#include "research/joined_palms.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

Quaternionf turned(const Vector3f& from, const Vector3f& to, const Quaternionf& R) {
  return (shortest_turn(from.cast<double>(), to.cast<double>()).cast<float>() * R).normalized();
}

// By the arm alone: the elbow stays on its side, the hand turned as it is.
void move_palm(const Skeleton& skeleton, std::size_t side, const Vector3f& shift,
               BodyFrames& frames, Pose& pose) {
  const Limb arm = side == 0 ? kLeftArm : kRightArm;
  const std::size_t upper = index_of(arm.upper), lower = index_of(arm.lower),
                    end = index_of(arm.end);
  const Vector3f shoulder = frames.p_WB_m[upper], elbow = frames.p_WB_m[lower],
                 wrist = frames.p_WB_m[end];
  const Quaternionf R_WU = frames.R_WB[upper], R_WL = frames.R_WB[lower], R_WE = frames.R_WB[end];
  const Vector3f along = (wrist - shoulder).normalized();
  const Vector3f bend = (elbow - shoulder) - along * along.dot(elbow - shoulder);
  solve_two_bone(skeleton, arm, wrist + shift, bend - 0.01f * (R_WU * Vector3f::UnitZ()), R_WE,
                 pose, frames);
  frames.R_WB[upper] = turned(elbow - shoulder, frames.p_WB_m[lower] - shoulder, R_WU);
  frames.R_WB[lower] = turned(wrist - elbow, frames.p_WB_m[end] - frames.p_WB_m[lower], R_WL);
  const auto parent = static_cast<std::size_t>(kBones[upper].parent);
  pose.R_PB[upper] = (frames.R_WB[parent].conjugate() * frames.R_WB[upper]).normalized();
  pose.R_PB[lower] = (frames.R_WB[upper].conjugate() * frames.R_WB[lower]).normalized();
  pose.R_PB[end] = (frames.R_WB[lower].conjugate() * R_WE).normalized();
}

}  // namespace

Result<std::vector<CoupleTake>> couples_of(std::vector<PredictTake> takes) {
  if (takes.empty() || takes.size() % 2 != 0)
    return fail("--partner takes files in pairs, the two dancers of a dance behind each other: " +
                std::to_string(takes.size()) + " files are no pairs");
  std::vector<CoupleTake> couples;
  for (std::size_t i = 0; i < takes.size(); i += 2) {
    CoupleTake couple{std::move(takes[i]), std::move(takes[i + 1])};
    const std::size_t a = couple[0].poses.size(), b = couple[1].poses.size();
    if (10 * std::min(a, b) < 9 * std::max(a, b))
      return fail(fmt::format("{} has {} frames and {} has {}: they are not of one dance",
                              couple[0].name, a, couple[1].name, b));
    for (PredictTake& take : couple) take.poses.resize(std::min(a, b));
    couples.push_back(std::move(couple));
  }
  return couples;
}

void join_palms(CoupleTake& couple, float join_m) {
  if (join_m <= 0.0f) return;
  for (std::size_t i = 0; i < couple[0].poses.size(); ++i) {
    std::array<BodyFrames, 2> frames;
    std::array<PalmPlaces, 2> palms;
    for (std::size_t d = 0; d < 2; ++d) {
      forward_kinematics(couple[d].skeleton, couple[d].poses[i], frames[d]);
      for (std::size_t side = 0; side < 2; ++side)
        palms[d][side] = palm_of(couple[d].skeleton, frames[d], side);
    }
    const auto shift = joined_palm_shifts(palms, join_m);
    for (std::size_t d = 0; d < 2; ++d)
      for (std::size_t side = 0; side < 2; ++side)
        if (shift[d][side].norm() > 1e-6f)
          move_palm(couple[d].skeleton, side, shift[d][side], frames[d], couple[d].poses[i]);
  }
}

}  // namespace dance

#include "core/motion/palm_pull.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/motion/rotation_vector.h"

namespace dance {

using Eigen::Matrix3f;
using Eigen::Quaternionf;
using Eigen::Vector3f;
using Matrix6f = Eigen::Matrix<float, 6, 6>;
using Vector6f = Eigen::Matrix<float, 6, 1>;

namespace {

// What predictions of salsa are wrong by at 200 ms, root of the mean square about each axis.
constexpr float kHeading_rad = 0.126f, kPlace_m = 0.027f;
struct Link {
  Bone bone;
  float rad;
};
constexpr std::array<Link, 3> kTrunk{
    {{Bone::kSpine, 0.07f}, {Bone::kChest, 0.035f}, {Bone::kUpperChest, 0.008f}}};
constexpr std::array<std::array<Link, 4>, 2> kArms{{{{{Bone::kLeftShoulder, 0.11f},
                                                      {Bone::kLeftUpperArm, 0.16f},
                                                      {Bone::kLeftLowerArm, 0.155f},
                                                      {Bone::kLeftHand, 0.1f}}},
                                                    {{{Bone::kRightShoulder, 0.11f},
                                                      {Bone::kRightUpperArm, 0.16f},
                                                      {Bone::kRightLowerArm, 0.155f},
                                                      {Bone::kRightHand, 0.1f}}}}};
constexpr std::size_t kElbow = 2;  // in an arm
constexpr float kLeastShare = 1e-3f, kMostShare = 0.995f;
constexpr float kMostShift_m = 0.5f;
constexpr float kMostTurn_rad = 0.8f;  // of one joint, by one step
constexpr int kSteps = 2;
constexpr float kStraight_m = 0.03f;

Matrix3f crossed(const Vector3f& r) {
  Matrix3f m;
  m << 0.0f, -r.z(), r.y(), r.z(), 0.0f, -r.x(), -r.y(), r.x(), 0.0f;
  return m;
}

// How a palm moves with one joint: a turn about any axis, or about one.
struct Lever {
  std::size_t bone;
  float variance;
  Vector3f arm;   // from the joint to the palm
  Vector3f axis;  // zero: any
  // What a turn of that variance moves two palms by, together.
  Matrix3f with(const Lever& other) const {
    if (!axis.isZero()) {
      const Vector3f a = axis.cross(arm), b = axis.cross(other.arm);
      return variance * a * b.transpose();
    }
    return variance * crossed(arm) * crossed(other.arm).transpose();
  }
  Vector3f turn_for(const Vector3f& force) const {
    const Vector3f turn = variance * arm.cross(force);
    return axis.isZero() ? turn : Vector3f(axis * axis.dot(turn));
  }
};

constexpr std::size_t kShared = 1 + kTrunk.size();
constexpr std::size_t kLevers = kShared + 4;
using Chain = std::array<Lever, kLevers>;

Chain chain_of(const BodyFrames& frames, const Vector3f& palm, std::size_t side) {
  Chain chain;
  const auto lever = [&](Bone bone, float rad) {
    const std::size_t b = index_of(bone);
    return Lever{b, rad * rad, palm - frames.p_WB_m[b], Vector3f::Zero()};
  };
  chain[0] = lever(Bone::kHips, kHeading_rad);
  chain[0].axis = Vector3f::UnitY();
  for (std::size_t i = 0; i < kTrunk.size(); ++i)
    chain[1 + i] = lever(kTrunk[i].bone, kTrunk[i].rad);
  for (std::size_t i = 0; i < 4; ++i)
    chain[kShared + i] = lever(kArms[side][i].bone, kArms[side][i].rad);
  // In T-pose an elbow bends about the vertical.
  Lever& elbow = chain[kShared + kElbow];
  elbow.axis = frames.R_WB[elbow.bone] * Vector3f::UnitY();
  return chain;
}

void turn_joint(std::size_t bone, const Vector3f& turn_W, const BodyFrames& frames, Pose& pose) {
  const float size = turn_W.norm();
  const Vector3f turn = size > kMostTurn_rad ? Vector3f(turn_W * (kMostTurn_rad / size)) : turn_W;
  const Quaternionf by = exp_rotation(turn);
  if (bone == 0) {
    pose.R_PB[0] = (by * pose.R_PB[0]).normalized();
    return;
  }
  const Quaternionf& R_WP = frames.R_WB[static_cast<std::size_t>(kBones[bone].parent)];
  pose.R_PB[bone] = (R_WP.conjugate() * by * R_WP * pose.R_PB[bone]).normalized();
}

}  // namespace

Vector3f palm_of(const Skeleton& skeleton, const BodyFrames& frames, std::size_t side) {
  const std::size_t hand = index_of(kHandBones[side]);
  const Tip tip = side == 0 ? Tip::kLeftHand : Tip::kRightHand;
  return frames.p_WB_m[hand] + frames.R_WB[hand] * (0.5f * skeleton.tip(tip));
}

bool pull_palms(const Skeleton& skeleton, const std::array<PalmPull, 2>& pulls, Pose& pose) {
  std::array<float, 2> share{};
  std::array<Vector3f, 2> left;  // of the shift
  for (std::size_t side = 0; side < 2; ++side) {
    const PalmPull& pull = pulls[side];
    left[side].setZero();
    if (!pull.shift_W_m.allFinite() || !(pull.share > kLeastShare)) continue;
    share[side] = std::min(pull.share, kMostShare);
    const float size = pull.shift_W_m.norm();
    left[side] = pull.shift_W_m * std::min(1.0f, kMostShift_m / std::max(size, 1e-6f));
  }
  if (share[0] == 0.0f && share[1] == 0.0f) return false;
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  float furthest = 0.0f;
  for (std::size_t side = 0; side < 2; ++side)
    furthest = std::max(furthest, share[side] * left[side].norm());
  // Small shifts are straight lines.
  const int steps = furthest > kStraight_m ? kSteps : 1;
  for (int step = 0; step < steps; ++step) {
    std::array<Chain, 2> chains;
    std::array<Vector3f, 2> palms;
    for (std::size_t side = 0; side < 2; ++side) {
      palms[side] = palm_of(skeleton, frames, side);
      chains[side] = chain_of(frames, palms[side], side);
    }
    Matrix6f moves = Matrix6f::Zero();
    const Matrix3f along_floor = Vector3f(1.0f, 0.0f, 1.0f).asDiagonal();
    for (std::size_t a = 0; a < 2; ++a)
      for (std::size_t b = 0; b < 2; ++b) {
        Matrix3f sum = kPlace_m * kPlace_m * along_floor;
        const std::size_t last = a == b ? kLevers : kShared;
        for (std::size_t i = 0; i < last; ++i) sum += chains[a][i].with(chains[b][i]);
        moves.block<3, 3>(static_cast<Eigen::Index>(3 * a), static_cast<Eigen::Index>(3 * b)) = sum;
      }
    // The share as the noise of what is known: it takes that part of the shift, were it alone.
    Matrix6f noisy = moves;
    Vector6f wanted = Vector6f::Zero();
    for (std::size_t side = 0; side < 2; ++side) {
      const auto at = static_cast<Eigen::Index>(3 * side);
      const float variance = moves.block<3, 3>(at, at).trace() / 3.0f;
      const float noise =
          step > 0 && share[side] > 0.0f
              ? 1e-4f * variance
              : variance * (1.0f - share[side]) / std::max(share[side], kLeastShare * 1e-3f);
      for (Eigen::Index i = 0; i < 3; ++i) noisy(at + i, at + i) += noise;
      wanted.segment<3>(at) = left[side];
    }
    const Vector6f force = noisy.ldlt().solve(wanted);
    if (!force.allFinite()) return step > 0;
    // After the first step: how far the palms were to move, and have not.
    const Vector6f expected = moves * force;
    std::array<Vector3f, kShared> shared;
    for (std::size_t i = 0; i < kShared; ++i) shared[i].setZero();
    Vector3f place = Vector3f::Zero();
    for (std::size_t side = 0; side < 2; ++side) {
      if (share[side] == 0.0f) continue;
      const Vector3f f = force.segment<3>(static_cast<Eigen::Index>(3 * side));
      place += kPlace_m * kPlace_m * (along_floor * f);
      for (std::size_t i = 0; i < kLevers; ++i) {
        const Vector3f turn = chains[side][i].turn_for(f);
        if (i < kShared)
          shared[i] += turn;
        else
          turn_joint(chains[side][i].bone, turn, frames, pose);
      }
    }
    for (std::size_t i = 0; i < kShared; ++i)
      turn_joint(chains[0][i].bone, shared[i], frames, pose);
    pose.p_WH_m += place;
    if (step + 1 == steps) return true;
    forward_kinematics(skeleton, pose, frames);
    for (std::size_t side = 0; side < 2; ++side)
      left[side] =
          share[side] > 0.0f
              ? Vector3f(palms[side] + expected.segment<3>(static_cast<Eigen::Index>(3 * side)) -
                         palm_of(skeleton, frames, side))
              : Vector3f(Vector3f::Zero());
  }
  return true;
}

}  // namespace dance

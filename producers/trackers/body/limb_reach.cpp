#include "producers/trackers/body/limb_reach.h"

#include <algorithm>
#include <cmath>

#include "core/motion/rotation_vector.h"
#include "core/pose/shortest_turn.h"

namespace dance {
namespace {

using Eigen::Matrix3f;
using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr std::array kSpineBones{Bone::kSpine, Bone::kChest, Bone::kUpperChest, Bone::kNeck};
constexpr std::array kSpineEnds{Bone::kChest, Bone::kUpperChest, Bone::kNeck, Bone::kHead};
// The lower spine carries more of a bend than the neck.
constexpr std::array kSpineShares{1.5f, 0.7f, 0.2f, 0.1f};
constexpr int kSpineRounds = 8;
constexpr float kSpineDamping = 2e-4f, kSpineMostTurn_rad = 0.25f;
constexpr float kMostShoulder_rad = 0.45f;
constexpr float kStraightest = 0.9995f;
// A knee that straightens altogether does so at any speed: the heel rises before.
constexpr float kStraightLeg = 0.992f;
constexpr float kMostHeel_rad = 1.0f, kMostToes_rad = 1.3f;
constexpr int kHalvings = 10;
// The heel's underside from the ankle, of the ankle's height and the foot's length.
constexpr float kHeelBack = 0.3f;

// The largest x in 0 … most for which is_enough(x) is false, to within a thousandth.
template <class Enough>
float least_enough(float most, const Enough& is_enough) {
  if (is_enough(0.0f)) return 0.0f;
  float low = 0.0f, high = most;
  for (int i = 0; i < kHalvings; ++i) {
    const float middle = 0.5f * (low + high);
    (is_enough(middle) ? high : low) = middle;
  }
  return high;
}

Quaternionf about_x(float angle_rad) {
  return Quaternionf(Eigen::AngleAxisf(angle_rad, Vector3f::UnitX()));
}

Vector3f along_spine(const Skeleton& skeleton, BodyFrames& frames) {
  for (const Bone bone :
       {Bone::kSpine, Bone::kChest, Bone::kUpperChest, Bone::kNeck, Bone::kHead}) {
    const std::size_t b = index_of(bone);
    const auto parent = static_cast<std::size_t>(kBones[b].parent);
    frames.p_WB_m[b] = frames.p_WB_m[parent] + frames.R_WB[parent] * skeleton.offset_m[b];
  }
  return frames.position(Bone::kHead);
}

}  // namespace

Quaternionf turned_along(const Vector3f& from, const Vector3f& to, const Quaternionf& R) {
  return (shortest_turn(from.cast<double>(), to.cast<double>()).cast<float>() * R).normalized();
}

void bend_spine(const Skeleton& skeleton, const Vector3f& p_WHead_m, BodyFrames& frames) {
  const Vector3f chain = along_spine(skeleton, frames) - frames.p_WB_m[0];
  const Vector3f apart = p_WHead_m - frames.position(Bone::kHead);
  frames.p_WB_m[0] += chain.dot(apart) / std::max(chain.squaredNorm(), 1e-6f) * chain;
  for (int round = 0; round < kSpineRounds; ++round) {
    const Vector3f left = p_WHead_m - along_spine(skeleton, frames);
    if (left.squaredNorm() < 1e-10f) break;
    // Each bone turns by w s x (A^-1 left), with A the sum of w (s's I - s s') and the damping.
    Matrix3f A = kSpineDamping * Matrix3f::Identity();
    std::array<Vector3f, kSpineBones.size()> s;
    for (std::size_t i = 0; i < s.size(); ++i) {
      s[i] = frames.R_WB[index_of(kSpineBones[i])] * skeleton.offset(kSpineEnds[i]);
      A += kSpineShares[i] * (s[i].squaredNorm() * Matrix3f::Identity() - s[i] * s[i].transpose());
    }
    const Vector3f pull = A.inverse() * left;
    for (std::size_t i = 0; i < s.size(); ++i) {
      Vector3f turn = kSpineShares[i] * s[i].cross(pull);
      if (const float angle = turn.norm(); angle > kSpineMostTurn_rad)
        turn *= kSpineMostTurn_rad / angle;
      Quaternionf& R = frames.R_WB[index_of(kSpineBones[i])];
      R = (exp_rotation(turn) * R).normalized();
    }
  }
  frames.p_WB_m[0] += p_WHead_m - along_spine(skeleton, frames);
  along_spine(skeleton, frames);
}

void raise_shoulder(const Skeleton& skeleton, const Limb& arm, const Vector3f& target_W_m,
                    BodyFrames& frames) {
  const std::size_t upper = index_of(arm.upper);
  const auto shoulder = static_cast<std::size_t>(kBones[upper].parent);
  const float reach_m =
      kStraightest * (skeleton.offset(arm.lower).norm() + skeleton.offset(arm.end).norm());
  const Quaternionf R = frames.R_WB[shoulder];
  const Vector3f collar = R * skeleton.offset_m[upper];
  const Vector3f to_target = target_W_m - frames.p_WB_m[shoulder];
  const Vector3f turn =
      rotation_vector(shortest_turn(collar.cast<double>(), to_target.cast<double>()).cast<float>());
  const float angle = turn.norm();
  if (angle > 1e-4f) {
    const float part = least_enough(std::min(angle, kMostShoulder_rad), [&](float x) {
      return (to_target - exp_rotation(x / angle * turn) * collar).norm() <= reach_m;
    });
    frames.R_WB[shoulder] = (exp_rotation(part / angle * turn) * R).normalized();
  }
  frames.p_WB_m[upper] = frames.p_WB_m[shoulder] + frames.R_WB[shoulder] * skeleton.offset_m[upper];
}

float reach_limb(const Skeleton& skeleton, const Limb& limb, const Vector3f& target_W_m,
                 const Vector3f& middle_W_m, const Vector3f& bend_W, BodyFrames& frames) {
  const std::size_t upper = index_of(limb.upper), lower = index_of(limb.lower),
                    end = index_of(limb.end);
  const float a = skeleton.offset_m[lower].norm(), b = skeleton.offset_m[end].norm();
  const Vector3f root = frames.p_WB_m[upper];
  const Vector3f to_target = target_W_m - root;
  const float wanted = to_target.norm();
  if (a < 1e-3f || b < 1e-3f || wanted < 1e-4f) return wanted;
  const Vector3f along = to_target / wanted;
  const float reach = std::clamp(wanted, std::abs(a - b) + 1e-3f, kStraightest * (a + b));
  Vector3f bend = middle_W_m - root;
  bend -= along * along.dot(bend);
  bend += bend_W - along * along.dot(bend_W);
  if (bend.squaredNorm() < 1e-10f) bend = along.unitOrthogonal();
  bend.normalize();
  // Law of cosines: the middle joint lies at x along the line and y beside it.
  const float x = (a * a - b * b + reach * reach) / (2.0f * reach);
  const float y = std::sqrt(std::max(0.0f, a * a - x * x));
  const Vector3f middle = root + x * along + y * bend;
  frames.p_WB_m[lower] = middle;
  frames.p_WB_m[end] = root + reach * along;
  frames.R_WB[upper] = turned_along(frames.R_WB[upper] * skeleton.offset_m[lower], middle - root,
                                    frames.R_WB[upper]);
  frames.R_WB[lower] = turned_along(frames.R_WB[lower] * skeleton.offset_m[end],
                                    frames.p_WB_m[end] - middle, frames.R_WB[lower]);
  return std::abs(wanted - reach);
}

void raise_heel(const Vector3f& hip_W_m, float leg_m, const Vector3f& o_ball, Place& foot) {
  const Vector3f ball = foot.p_W_m + foot.R_W * o_ball;
  const Quaternionf R = foot.R_W;
  const auto ankle_at = [&](float pitch) { return Vector3f(ball - R * about_x(pitch) * o_ball); };
  const float pitch = least_enough(kMostHeel_rad, [&](float x) {
    return (ankle_at(x) - hip_W_m).norm() <= kStraightLeg * leg_m;
  });
  foot.R_W = (R * about_x(pitch)).normalized();
  foot.p_W_m = ankle_at(pitch);
}

void keep_above_floor(const Skeleton& skeleton, bool left, Place& foot) {
  const Vector3f o_ball = skeleton.offset(left ? Bone::kLeftToes : Bone::kRightToes);
  const Vector3f o_tip = skeleton.tip(left ? Tip::kLeftToes : Tip::kRightToes);
  const float sole = -o_tip.y() - o_ball.y();
  const Vector3f heel(0.0f, -sole, -kHeelBack * o_ball.z());
  const float lowest = std::min((foot.R_W * o_ball).y() + o_tip.y(), (foot.R_W * heel).y());
  foot.p_W_m.y() = std::max(foot.p_W_m.y(), -lowest);
}

Quaternionf toes_on_floor(const Skeleton& skeleton, bool left, const Place& foot) {
  const Vector3f o_ball = skeleton.offset(left ? Bone::kLeftToes : Bone::kRightToes);
  const Vector3f o_tip = skeleton.tip(left ? Tip::kLeftToes : Tip::kRightToes);
  const float ball = foot.p_W_m.y() + (foot.R_W * o_ball).y();
  const float bend = least_enough(kMostToes_rad, [&](float x) {
    return ball + (foot.R_W * about_x(-x) * o_tip).y() >= -1e-3f;
  });
  return (foot.R_W * about_x(-bend)).normalized();
}

}  // namespace dance

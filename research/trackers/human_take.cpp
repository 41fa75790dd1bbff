#include "research/trackers/human_take.h"

#include <algorithm>
#include <cmath>

#include "core/motion/leg_reach.h"
#include "core/pose/interpolate.h"

namespace dance {
namespace {

using Eigen::Vector3f;

// The computer figure's height against that of the person who was captured: its legs are short.
constexpr float kFigureToPerson = 1.06f;
constexpr std::array kHumanLegs{kLeftLeg, kRightLeg};
constexpr std::array kHumanBalls{Bone::kLeftToes, Bone::kRightToes};

struct RestHeights {
  float ankle, ball, leg;
};

RestHeights rest_heights(const Skeleton& s) {
  RestHeights rest{};
  rest.leg = s.offset(Bone::kLeftLowerLeg).norm() + s.offset(Bone::kLeftFoot).norm();
  rest.ankle = s.hips_height_m() + s.offset(Bone::kLeftUpperLeg).y() +
               s.offset(Bone::kLeftLowerLeg).y() + s.offset(Bone::kLeftFoot).y();
  rest.ball = rest.ankle + s.offset(Bone::kLeftToes).y();
  return rest;
}

// The floor of a recording, from where the balls of its feet are lowest.
float floor_of(const PredictTake& take, float rest_ball) {
  std::vector<float> lows;
  BodyFrames frames;
  for (const Pose& pose : take.poses) {
    forward_kinematics(take.skeleton, pose, frames);
    lows.push_back(
        std::min(frames.position(kHumanBalls[0]).y(), frames.position(kHumanBalls[1]).y()));
  }
  std::sort(lows.begin(), lows.end());
  return lows[lows.size() / 10] - rest_ball;
}

}  // namespace

Skeleton human_skeleton(float height_m, float spread, Random& random) {
  Skeleton s = average_skeleton(height_m);
  const auto scaled = [&](std::initializer_list<Bone> bones) {
    const float by = 1.0f + spread * std::clamp(static_cast<float>(random.normal()), -2.5f, 2.5f);
    for (const Bone bone : bones) s.offset_m[index_of(bone)] *= by;
  };
  scaled({Bone::kSpine, Bone::kChest, Bone::kUpperChest, Bone::kNeck});
  scaled({Bone::kHead});
  scaled({Bone::kLeftShoulder, Bone::kRightShoulder, Bone::kLeftUpperArm, Bone::kRightUpperArm});
  scaled({Bone::kLeftLowerArm, Bone::kRightLowerArm});
  scaled({Bone::kLeftHand, Bone::kRightHand});
  scaled({Bone::kLeftUpperLeg, Bone::kRightUpperLeg});
  scaled({Bone::kLeftLowerLeg, Bone::kRightLowerLeg});
  const float ankle = rest_heights(average_skeleton(height_m)).ankle;
  scaled({Bone::kLeftFoot, Bone::kRightFoot});
  scaled({Bone::kLeftToes, Bone::kRightToes});
  // Standing on the floor again.
  s.offset_m[0].y() = ankle - s.offset(Bone::kLeftUpperLeg).y() -
                      s.offset(Bone::kLeftLowerLeg).y() - s.offset(Bone::kLeftFoot).y();
  for (Vector3f* tip : {&s.tip_m[3], &s.tip_m[4]}) tip->y() = -rest_heights(s).ball;
  return s;
}

float dancer_height_m(const PredictTake& take) {
  return kFigureToPerson * standing_height_m(take.skeleton);
}

PredictTake on_body(const PredictTake& take, const Skeleton& body) {
  PredictTake out = take;
  out.skeleton = body;
  const RestHeights was = rest_heights(take.skeleton), is = rest_heights(body);
  const float grows = is.leg / was.leg;
  const float floor = floor_of(take, was.ball);
  BodyFrames from, like, frames;
  for (Pose& pose : out.poses) {
    pose.p_WH_m.y() -= floor;
    forward_kinematics(take.skeleton, pose, from);
    const auto middle = [](const BodyFrames& f) {
      return Vector3f(0.5f * (f.position(Bone::kLeftUpperLeg) + f.position(Bone::kRightUpperLeg)));
    };
    Vector3f hips = grows * middle(from);
    hips.y() += is.ankle - grows * was.ankle;
    forward_kinematics(body, pose, like);
    pose.p_WH_m += hips - middle(like);
    forward_kinematics(body, pose, like);
    frames = like;
    for (std::size_t side = 0; side < 2; ++side) {
      const Bone ball = kHumanBalls[side];
      Vector3f place = grows * from.position(ball);
      place.y() = std::max(0.5f * is.ball, place.y() + is.ball - grows * was.ball);
      const Eigen::Quaternionf R = from.R_WB[index_of(kHumanLegs[side].end)];
      const Vector3f ankle = place - R * body.offset(ball);
      reach_ankle(body, kHumanLegs[side], like, ankle, R, pose, frames);
    }
  }
  return out;
}

PredictTake at_rate(const PredictTake& take, double hz) {
  PredictTake out = take;
  out.hz = hz;
  out.poses.clear();
  const auto count =
      static_cast<std::size_t>(static_cast<double>(take.poses.size() - 1) / take.hz * hz);
  for (std::size_t i = 0; i < count; ++i) {
    const double at = static_cast<double>(i) / hz * take.hz;
    const auto k = std::min(static_cast<std::size_t>(at), take.poses.size() - 2);
    const Pose* before = k > 0 ? &take.poses[k - 1] : nullptr;
    const Pose* after = k + 2 < take.poses.size() ? &take.poses[k + 2] : nullptr;
    Pose pose = interpolate_smoothly(before, take.poses[k], take.poses[k + 1], after,
                                     static_cast<float>(at - static_cast<double>(k)));
    normalize(pose);
    pose.capture_time = MonoTime() + Duration::seconds(1.0 + static_cast<double>(i) / hz);
    out.poses.push_back(pose);
  }
  return out;
}

}  // namespace dance

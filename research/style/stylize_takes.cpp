#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/motion/leg_reach.h"
#include "core/motion/rotation_vector.h"
#include "research/style/stylize_eval.h"
#include "testing/motion/motion_measures.h"
#include "testing/motion/take_grid.h"
#include "transformers/predict/model/predict_model.h"
#include "transformers/tempo/period.h"

namespace dance {
namespace {

using Eigen::Vector3f;

MonoTime style_moment(double t_s) {
  return MonoTime::from_ns(static_cast<std::int64_t>(1e9 * (1.0 + t_s)));
}

constexpr double kSway_bpm = 170.0;
constexpr double kSwayLength_s = 120.0;

float wave(double bars, double phase_rad) {
  return static_cast<float>(std::sin(2.0 * std::numbers::pi * bars + phase_rad));
}

}  // namespace

StyleTake style_take_of(const CodecTake& take, double tempo_off_percent) {
  StyleTake out{take.name, take.skeleton, take.hz, 0.0, take.poses};
  const TakeGrid grid = find_take_grid(JointTrack(take.skeleton, take.poses, take.hz));
  const double pace = 1.0 + tempo_off_percent / 100.0;
  out.tempo_bpm = pace * grid.tempo_bpm;
  for (std::size_t i = 0; i < out.poses.size(); ++i) {
    const double t_s = static_cast<double>(i) / take.hz;
    out.poses[i].capture_time = style_moment(t_s);
    out.poses[i].clock_id = 1;
    out.poses[i].music_beats = pace * grid.beats_at(t_s);
  }
  return out;
}

std::vector<StyleTake> joined(std::span<const StyleTake> takes) {
  constexpr float kSameBody_m = 1e-3f;
  std::vector<StyleTake> out;
  for (const StyleTake& take : takes) {
    if (take.poses.empty()) continue;
    if (out.empty() || out.back().hz != take.hz ||
        !is_alike(bone_lengths(out.back().skeleton), bone_lengths(take.skeleton), kSameBody_m)) {
      out.push_back(take);
      continue;
    }
    StyleTake& dance = out.back();
    const Pose last = dance.poses.back(), first = take.poses.front();
    const Duration later =
        last.capture_time + Duration::seconds(1.0 / take.hz) - first.capture_time;
    // Two bars, or four … later: the next take is on its own one, and so are the half harmonics.
    const double bars =
        2.0 * std::ceil((last.music_beats - first.music_beats) / (2.0 * Period::kBeatsPerBar));
    for (Pose pose : take.poses) {
      pose.capture_time += later;
      pose.music_beats += bars * Period::kBeatsPerBar;
      dance.poses.push_back(pose);
    }
    dance.name += " " + take.name;
  }
  return out;
}

StyleTake synthetic_sway(double hz) {
  StyleTake take{"synthetic", average_skeleton(), hz, kSway_bpm, {}};
  Random random(17);
  const auto noise = [&] {
    return static_cast<float>((random.uniform() + random.uniform() + random.uniform() - 1.5) *
                              2.0);  // of unit variance
  };
  constexpr float kNoise_rad = 0.5f * 0.017453293f;
  const float knees_m = 0.06f;  // so far the hips are below standing: legs have room
  Vector3f feet[2];
  Eigen::Quaternionf R_feet[2];
  Pose still;
  still.p_WH_m = {0.0f, take.skeleton.hips_height_m(), 0.0f};
  BodyFrames standing;
  forward_kinematics(take.skeleton, still, standing);
  for (std::size_t side = 0; side < 2; ++side) {
    const Limb& leg = side == 0 ? kLeftLeg : kRightLeg;
    feet[side] = standing.position(leg.end);
    R_feet[side] = standing.R_WB[index_of(leg.end)];
  }
  for (int i = 0; i < static_cast<int>(kSwayLength_s * hz); ++i) {
    const double t_s = i / hz, bars = t_s * kSway_bpm / 240.0;
    Pose pose = still;
    for (std::size_t b = 0; b < kBoneCount; ++b) {
      const double own = 0.7 * static_cast<double>(b);
      const float drift = 0.05f * wave(t_s / 40.0, own);
      const Vector3f turn(0.10f * wave(bars, own) + drift,
                          b == 0 ? 0.0f : 0.08f * wave(0.5 * bars, own + 1.0),
                          0.06f * wave(2.0 * bars, own + 2.0) + 0.03f * wave(1.5 * bars, own));
      pose.R_PB[b] = exp_rotation(turn + kNoise_rad * Vector3f(noise(), noise(), noise()));
    }
    pose.p_WH_m += Vector3f(0.05f * wave(0.5 * bars, 0.0) + 0.02f * wave(1.5 * bars, 1.0),
                            -knees_m + 0.01f * wave(bars, 0.5), 0.0f) +
                   0.001f * Vector3f(noise(), noise(), noise());
    BodyFrames frames;
    forward_kinematics(take.skeleton, pose, frames);
    for (std::size_t side = 0; side < 2; ++side)
      reach_ankle(take.skeleton, side == 0 ? kLeftLeg : kRightLeg, standing, feet[side],
                  R_feet[side], pose, frames);
    pose.capture_time = style_moment(t_s);
    pose.clock_id = 1;
    pose.music_beats = 4.0 * bars;
    take.poses.push_back(pose);
  }
  return take;
}

}  // namespace dance

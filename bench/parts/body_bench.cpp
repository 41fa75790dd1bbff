// What do forward kinematics with quaternions cost, against the same chain with 4×4 matrices?
#include <benchmark/benchmark.h>

#include "bench/parts/salsa_poses.h"
#include "core/pose/interpolate.h"
#include "core/pose/kinematics.h"

namespace dance {
namespace {

void matrices(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  const Skeleton skeleton = average_skeleton();
  std::array<Eigen::Affine3f, kBoneCount> T_WB;
  std::array<Eigen::Vector3f, kTipCount> p_WT_m;
  std::size_t i = 0;
  for (auto _ : state) {
    const Pose& pose = poses[i++ % poses.size()];
    for (std::size_t b = 0; b < kBoneCount; ++b) {
      if (b == 0) {
        T_WB[b] = Eigen::Translation3f(pose.p_WH_m) * pose.R_PB[b];
        continue;
      }
      T_WB[b] = T_WB[static_cast<std::size_t>(kBones[b].parent)] *
                Eigen::Translation3f(skeleton.offset_m[b]) * pose.R_PB[b];
    }
    for (std::size_t t = 0; t < kTipCount; ++t)
      p_WT_m[t] = T_WB[index_of(kTipBones[t])] * skeleton.tip_m[t];
    benchmark::DoNotOptimize(T_WB);
    benchmark::DoNotOptimize(p_WT_m);
  }
}
BENCHMARK(matrices)->Name("body: joints in the world/baseline");

void quaternions(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  const Skeleton skeleton = average_skeleton();
  BodyFrames frames;
  std::size_t i = 0;
  for (auto _ : state) {
    forward_kinematics(skeleton, poses[i++ % poses.size()], frames);
    benchmark::DoNotOptimize(frames);
  }
}
BENCHMARK(quaternions)->Name("body: joints in the world/ours");

}  // namespace
}  // namespace dance

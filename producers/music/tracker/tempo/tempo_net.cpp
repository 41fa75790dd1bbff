#include "producers/music/tracker/tempo/tempo_net.h"

#include <algorithm>

namespace dance {
namespace {

constexpr float kMostTempoRatio = 6.0f;

}  // namespace

float TempoNet::judge(std::span<const float, RhythmPeriods::kCount> values) const {
  const Eigen::Map<const Input> x(values.data());
  Hidden hidden = in_bias;
  hidden.noalias() += in.lazyProduct(x);
  hidden = hidden.cwiseMax(0.0f);
  const Answer answer = out.lazyProduct(hidden) + out_bias;
  return std::clamp(answer[0] - answer[1], -kMostTempoRatio, kMostTempoRatio);
}

}  // namespace dance

#include "producers/music/tracker/stroke_net.h"

#include <algorithm>

namespace dance {
namespace {

// No single stroke proves anything.
constexpr float kMostRatio = 5.0f;

}  // namespace

StrokeMeaning StrokeNet::judge(std::span<const float, StrokeFeatures::kCount> features) const {
  const Eigen::Map<const Input> x(features.data());
  Hidden hidden = in_bias;
  hidden.noalias() += in.lazyProduct(x);
  hidden = hidden.cwiseMax(0.0f);
  const Answer answer = out.lazyProduct(hidden) + out_bias;
  return {std::clamp(answer[0] - answer[2], -kMostRatio, kMostRatio),
          std::clamp(answer[1] - answer[2], -kMostRatio, kMostRatio)};
}

}  // namespace dance

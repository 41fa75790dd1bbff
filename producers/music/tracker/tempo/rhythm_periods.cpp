#include "producers/music/tracker/tempo/rhythm_periods.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"

namespace dance {
namespace {

// Means are over this long, and over what there was so far before that.
constexpr int kMemory_hops = 500;
constexpr float kMostStroke = 15.0f;
constexpr float kLeastPower = 1e-3f;
// The beat that is supposed may be wrong by half a hop, which grows with the beats.
constexpr double kReach_hops = 1.0;
constexpr double kReachABeat_hops = 0.5;
constexpr double kMiddlePeriod_hops = 48.0;

}  // namespace

RhythmPeriods::RhythmPeriods() { alike_.fill(Eigen::ArrayXf::Zero(kLags)); }

void RhythmPeriods::push(const OnsetStrength::Strengths& strengths) {
  if (begin_ == 0) {
    for (Group& group : groups_) group.past.tail(kLags) = group.past.head(kLags);
    begin_ = kRoom - kLags;
  }
  --begin_;
  hops_ = std::min(hops_ + 1, kMemory_hops);
  const float weight = 1.0f / static_cast<float>(hops_);
  std::array<float, kOnsetGroups> now{};
  for (std::size_t g = 0; g < kOnsetGroups; ++g) {
    Group& group = groups_[g];
    std::move_backward(group.newest.begin(), group.newest.end() - 1, group.newest.end());
    group.newest[0] = std::log1p(std::min(strengths[g], kMostStroke));
    float sum = 0.0f;
    for (const float x : group.newest) sum += x;
    group.mean += weight * (sum - group.mean);
    now[g] = sum - group.mean;
    group.past[begin_] = now[g];
    group.power += weight * (now[g] * now[g] - group.power);
  }
  for (std::size_t p = 0; p < kPairs.size(); ++p) {
    const auto [later, sooner] = kPairs[p];
    alike_[p] += weight * (now[later] * groups_[sooner].past.segment(begin_, kLags) - alike_[p]);
  }
}

void RhythmPeriods::read(double period_hops, std::span<float, kCount> values) const {
  DANCE_ASSERT(period_hops > 0.0 && period_hops <= kMostPeriod_hops);
  std::size_t at = 0;
  for (std::size_t p = 0; p < kPairs.size(); ++p) {
    const auto [later, sooner] = kPairs[p];
    const float scale =
        1.0f / std::max(std::sqrt(groups_[later].power * groups_[sooner].power), kLeastPower);
    for (const double lag_beats : kLags_beats) {
      const double lag = lag_beats * period_hops;
      const double reach = kReach_hops + kReachABeat_hops * (lag_beats - 1.0);
      const int first = static_cast<int>(std::ceil(lag - std::max(reach, kReach_hops)));
      const int last = static_cast<int>(std::floor(lag + std::max(reach, kReach_hops)));
      values[at++] = scale * alike_[p].segment(first, last - first + 1).maxCoeff();
    }
  }
  const auto tempo = static_cast<float>(std::log2(kMiddlePeriod_hops / period_hops));
  values[at++] = tempo;
  values[at++] = tempo * tempo;
}

}  // namespace dance

#include "transformers/tempo/step_signs.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr double kMean_s = 4.0, kSpread_s = 8.0;
constexpr float kMostSign = 3.0f;
constexpr float kFastestFoot_m_s = 3.0f;
// Between frames that are further apart nobody has seen the steps.
constexpr double kSeen_s = 0.3;
// A slot of which less was seen tells nothing.
constexpr double kLeastSeen_s = 0.05;
// What moves less than this counts as little as it moves: of the root of a foot's speed, the sway's
// speed, the heights in metres, the bounce's speed.
constexpr std::array<float, StepPattern::kSigns> kLeastVariance{1e-3f, 1e-3f, 1e-3f, 1e-5f, 1e-4f};

float hips_m(const MotionFrame& frame) {
  return frame.channel[1] + 0.5f * (frame.p_WFoot_m[0].y() + frame.p_WFoot_m[1].y());
}

}  // namespace

std::size_t StepSigns::add(const MotionFrame& frame) {
  count_ = 0;
  const Duration since = frame.time - last_.time;
  has_begun_anew_ = !has_last_ || since <= Duration() || since > kLongestPause;
  if (has_begun_anew_) {
    forget();
    has_begun_anew_ = has_last_ = true;
    last_ = frame;
    slot_end_ = frame.time + kSlot;
    return 0;
  }
  const double dt_s = since.as_seconds();
  const auto dt = static_cast<float>(dt_s);
  // Between two frames each sign is one value: a speed, or the mean of two places.
  std::array<float, StepPattern::kSigns> now{};
  for (std::size_t side = 0; side < 2; ++side)
    now[StepPattern::kLeftFoot + side] = std::sqrt(
        std::min(kFastestFoot_m_s, (frame.p_WFoot_m[side] - last_.p_WFoot_m[side]).norm() / dt));
  now[StepPattern::kSway] = (frame.sway_m - last_.sway_m) / dt;
  const auto higher_m = [](const MotionFrame& f) {
    return f.p_WFoot_m[0].y() - f.p_WFoot_m[1].y();
  };
  now[StepPattern::kHigherFoot] = 0.5f * (higher_m(frame) + higher_m(last_));
  now[StepPattern::kBounce] = (hips_m(frame) - hips_m(last_)) / dt;
  for (MonoTime from = last_.time; from < frame.time;) {
    const MonoTime to = std::min(frame.time, slot_end_);
    if (dt_s <= kSeen_s) {
      const double part_s = (to - from).as_seconds();
      seen_s_ += part_s;
      for (std::size_t i = 0; i < StepPattern::kSigns; ++i)
        sum_[i] += part_s * static_cast<double>(now[i]);
    }
    if (to == slot_end_) finish_slot();
    from = to;
  }
  last_ = frame;
  return count_;
}

void StepSigns::finish_slot() {
  Slot& slot = slots_[count_];
  if (count_ + 1 < kMostSlots) ++count_;
  slot = Slot();
  slot.middle = slot_end_ - kSlot / 2;
  slot.is_seen = seen_s_ >= kLeastSeen_s;
  slot_end_ += kSlot;
  if (slot.is_seen) {
    ++finished_;
    // The first slots are averaged, the later ones forget.
    const double first = 1.0 / finished_;
    const auto mean_share = static_cast<float>(std::max(kSlot_s / kMean_s, first));
    const auto spread_share = static_cast<float>(std::max(kSlot_s / kSpread_s, first));
    std::array<float, StepPattern::kSigns> value{};
    for (std::size_t i = 0; i < StepPattern::kSigns; ++i)
      value[i] = static_cast<float>(sum_[i] / seen_s_);
    const auto take = [&](Spread& spread, float mean) {
      spread.mean += mean_share * (mean - spread.mean);
    };
    for (std::size_t i = 0; i < StepPattern::kSigns; ++i) {
      if (i == StepPattern::kRightFoot) continue;
      Spread& spread = spread_[i];
      float square = 0.0f;
      if (i == StepPattern::kLeftFoot) {
        // Both feet have one scale: which of them goes is what tells.
        take(spread, 0.5f * (value[0] + value[1]));
        const float left = value[0] - spread.mean, right = value[1] - spread.mean;
        square = 0.5f * (left * left + right * right);
      } else {
        take(spread, value[i]);
        square = (value[i] - spread.mean) * (value[i] - spread.mean);
      }
      spread.variance += spread_share * (square - spread.variance);
    }
    spread_[StepPattern::kRightFoot] = spread_[StepPattern::kLeftFoot];
    for (std::size_t i = 0; i < StepPattern::kSigns; ++i)
      slot.sign[i] = std::clamp(
          (value[i] - spread_[i].mean) / std::sqrt(spread_[i].variance + kLeastVariance[i]),
          -kMostSign, kMostSign);
  }
  seen_s_ = 0.0;
  sum_ = {};
}

}  // namespace dance

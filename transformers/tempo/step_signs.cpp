#include "transformers/tempo/step_signs.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr double kSignMean_s = 4.0, kSignSpread_s = 8.0;
constexpr float kMostSign = 3.0f;
constexpr float kFastestStep_m_s = 3.0f;
// Between frames that are further apart nobody has seen the steps.
constexpr double kSeen_s = 0.3;
// A slot of which less was seen tells nothing.
constexpr double kLeastSeen_s = 0.05;
// What moves less than this counts as little as it moves: of the root of a foot's speed, the sway's
// speed, the heights in metres, the bounce's speed.
constexpr std::array<float, StepPattern::kSigns> kLeastSignVariance{1e-3f, 1e-3f, 1e-3f, 1e-5f,
                                                                    1e-4f};

}  // namespace

StepSigns::Places StepSigns::places_of(const MotionFrame& frame) {
  Places places;
  places.p_WFoot_m = frame.p_WFoot_m;
  places.sway_m = frame.sway_m;
  places.hips_m = frame.channel[1] + 0.5f * (frame.p_WFoot_m[0].y() + frame.p_WFoot_m[1].y());
  return places;
}

void StepSigns::Places::add(const Places& other, float share) {
  for (std::size_t side = 0; side < 2; ++side) p_WFoot_m[side] += share * other.p_WFoot_m[side];
  sway_m += share * other.sway_m;
  hips_m += share * other.hips_m;
}

void StepSigns::clear_sum() {
  seen_s_ = 0.0;
  sum_ = Places();
}

std::size_t StepSigns::add(const MotionFrame& frame) {
  count_ = 0;
  const Places places = places_of(frame);
  const Duration since = frame.time - last_time_;
  has_begun_anew_ = !has_last_ || since <= Duration() || since > kLongestPause;
  if (has_begun_anew_) {
    forget();
    has_begun_anew_ = has_last_ = true;
    last_ = places;
    last_time_ = frame.time;
    slot_end_ = frame.time + kSlot;
    return 0;
  }
  const double since_s = since.as_seconds();
  for (MonoTime from = last_time_; from < frame.time;) {
    const MonoTime to = std::min(frame.time, slot_end_);
    if (since_s <= kSeen_s) {
      // Straight between two frames: the middle of the part that lies in this slot.
      const double part_s = (to - from).as_seconds();
      const auto way =
          static_cast<float>(((from - last_time_).as_seconds() + 0.5 * part_s) / since_s);
      seen_s_ += part_s;
      sum_.add(last_, static_cast<float>(part_s) * (1.0f - way));
      sum_.add(places, static_cast<float>(part_s) * way);
    }
    if (to == slot_end_) finish_slot();
    from = to;
  }
  last_ = places;
  last_time_ = frame.time;
  return count_;
}

void StepSigns::finish_slot() {
  Slot& slot = slots_[count_];
  if (count_ + 1 < kMostSlots) ++count_;
  slot = Slot();
  slot.middle = slot_end_ - kSlot;
  slot_end_ += kSlot;
  const bool is_seen = seen_s_ >= kLeastSeen_s;
  Places now;
  if (is_seen) now.add(sum_, static_cast<float>(1.0 / seen_s_));
  if (is_seen && has_before_) judge(now, slot);
  has_before_ = is_seen;
  before_ = now;
  clear_sum();
}

void StepSigns::judge(const Places& now, Slot& slot) {
  slot.is_seen = true;
  ++judged_;
  // The first slots are averaged, the later ones forget.
  const double first = 1.0 / judged_;
  const auto mean_share = static_cast<float>(std::max(kSlot_s / kSignMean_s, first));
  const auto spread_share = static_cast<float>(std::max(kSlot_s / kSignSpread_s, first));
  constexpr auto kSlot_hz = static_cast<float>(1.0 / kSlot_s);
  std::array<float, StepPattern::kSigns> value{};
  for (std::size_t side = 0; side < 2; ++side)
    value[StepPattern::kLeftFoot + side] = std::sqrt(std::min(
        kFastestStep_m_s, kSlot_hz * (now.p_WFoot_m[side] - before_.p_WFoot_m[side]).norm()));
  const auto higher_m = [](const Places& p) { return p.p_WFoot_m[0].y() - p.p_WFoot_m[1].y(); };
  value[StepPattern::kSway] = kSlot_hz * (now.sway_m - before_.sway_m);
  value[StepPattern::kHigherFoot] = 0.5f * (higher_m(now) + higher_m(before_));
  value[StepPattern::kBounce] = kSlot_hz * (now.hips_m - before_.hips_m);

  for (std::size_t i = 0; i < StepPattern::kSigns; ++i) {
    if (i == StepPattern::kRightFoot) continue;
    Spread& spread = spread_[i];
    // Both feet have one scale: which of them goes is what tells.
    const bool is_foot = i == StepPattern::kLeftFoot;
    const float other = value[is_foot ? StepPattern::kRightFoot : i];
    spread.mean += mean_share * (0.5f * (value[i] + other) - spread.mean);
    const float one = value[i] - spread.mean, two = other - spread.mean;
    spread.variance += spread_share * (0.5f * (one * one + two * two) - spread.variance);
  }
  spread_[StepPattern::kRightFoot] = spread_[StepPattern::kLeftFoot];
  for (std::size_t i = 0; i < StepPattern::kSigns; ++i)
    slot.sign[i] = std::clamp(
        (value[i] - spread_[i].mean) / std::sqrt(spread_[i].variance + kLeastSignVariance[i]),
        -kMostSign, kMostSign);
}

}  // namespace dance

// What share of the datagrams of one direction is lost: slowly, so that one in a thousand can be
// told from none; and at once where a burst of losses says that the path has changed. And what
// share is lost together with the one before it.
//
// Units/frames: a share, 0 to 1.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <algorithm>
#include <cstdint>

namespace dance {

class LossMeter {
 public:
  void add(bool is_lost) {
    const float sample = is_lost ? 1.0f : 0.0f;
    // The mean of all at first, to which what was assumed counts as some datagrams.
    if (seen_ < kRemembers) ++seen_;
    slow_ += (sample - slow_) / static_cast<float>(seen_);
    quick_ += (sample - quick_) * (1.0f / 64.0f);
    const float pair = is_lost && was_lost_ ? 1.0f : 0.0f;
    pairs_ += (pair - pairs_) / static_cast<float>(seen_);
    was_lost_ = is_lost;
    lost_ += is_lost ? 1 : 0;
    ++counted_;
  }
  float loss() const {
    // One lost datagram alone makes the quick one 1/64.
    constexpr float kSuddenLoss = 0.03f;
    return quick_ > slow_ + kSuddenLoss ? quick_ : slow_;
  }
  // Never less than chance makes of the losses.
  float in_a_row() const { return std::max(pairs_, loss() * loss()); }
  std::uint64_t lost() const { return lost_; }
  std::uint64_t counted() const { return counted_; }  // lost or not

 private:
  static constexpr float kBeforeAny = 0.02f;  // nothing is known: some loss
  static constexpr std::uint32_t kAssumptionIsWorth = 32;
  static constexpr std::uint32_t kRemembers = 1024;
  std::uint32_t seen_ = kAssumptionIsWorth;
  float slow_ = kBeforeAny;
  float quick_ = kBeforeAny;
  float pairs_ = kBeforeAny * kBeforeAny;
  bool was_lost_ = false;
  std::uint64_t lost_ = 0, counted_ = 0;
};

}  // namespace dance

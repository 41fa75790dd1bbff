// StepSigns: what of a dance shows its steps, ten times a second, at about the size 1 for
// any dancer: the signs of a StepPattern. Poses may come at any rate.
//
// Units/frames: times of the poses' clock; signs are without their mean of the last four seconds
//               and over their spread of the last eight.
// Ownership:    fixed arrays; never allocates.
// Threads:      none inside; one owner.
// Failure:      a slot that was not seen well enough says so; its signs are those of nothing.
#pragma once

#include <array>
#include <cstddef>

#include "transformers/tempo/motion_channels.h"
#include "transformers/tempo/step_pattern.h"

namespace dance {

class StepSigns {
 public:
  static constexpr Duration kSlot = Duration::ms(100);
  static constexpr double kSlot_s = 0.1;
  // A pause that is longer begins anew.
  static constexpr Duration kLongestPause = Duration::s(2);

  struct Slot {
    MonoTime middle;  // of what it was seen in: two slots, as speeds are differences
    bool is_seen = false;
    std::array<float, StepPattern::kSigns> sign{};
  };

  // Frames in the order of their times. Returns how many slots it completed; they are read by
  // slot(0) .. until the next call.
  std::size_t add(const MotionFrame& frame);
  const Slot& slot(std::size_t i) const { return slots_[i]; }
  // True where the last frame began anew: what was known of the dance is of another one.
  bool has_begun_anew() const { return has_begun_anew_; }
  void forget() { *this = StepSigns(); }

 private:
  static constexpr std::size_t kMostSlots = 24;
  struct Spread {
    float mean = 0.0f, variance = 0.0f;
  };

  // Where things are, on average over a slot: sensors' noise falls out before there are speeds.
  struct Places {
    std::array<Eigen::Vector3f, 2> p_WFoot_m{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
    float sway_m = 0.0f, hips_m = 0.0f;
    void add(const Places& other, float share);
  };

  static Places places_of(const MotionFrame& frame);
  void finish_slot();
  void clear_sum();
  void judge(const Places& now, Slot& slot);

  std::array<Slot, kMostSlots> slots_{};
  std::size_t count_ = 0;
  MonoTime last_time_, slot_end_;
  Places last_, sum_, before_;  // of the last frame, of this slot so far, of the slot before
  bool has_last_ = false, has_before_ = false, has_begun_anew_ = false;
  double seen_s_ = 0.0;
  std::array<Spread, StepPattern::kSigns> spread_{};  // the right foot has the left one's
  int judged_ = 0;
};

}  // namespace dance

// HandsQueue: fingers that wait for their body. A transformer shows the body later than it came;
// the fingers of that moment are shown with it, by capture time.
//
// Units/frames: capture times of the dancer's poses, whatever clock they are of.
// Ownership:    keeps up to 256 hands (two seconds at 120 Hz); never allocates.
// Threads:      none inside; one owner.
// Failure:      hands that are not newer are dropped; when it is full the oldest give way.
#pragma once

#include <array>

#include "core/pose/pose.h"

namespace dance {

class HandsQueue {
 public:
  void push(const Hands& hands) {
    if (size_ > 0) {
      const Duration after = hands.capture_time - at(size_ - 1).capture_time;
      // A source that jumps back began anew: what waits belongs to what was before.
      if (after < -kJump || hands.clock_id != at(size_ - 1).clock_id)
        size_ = 0;
      else if (after <= Duration())
        return;
    }
    if (size_ == slots_.size()) drop(1);
    slots_[(begin_ + size_++) % slots_.size()] = hands;
  }

  // The newest that are due with a body captured then, and none after them; null where nothing new
  // is due. Those of another clock than the body's are due at once. Valid until the next call.
  const Hands* take_due(MonoTime capture, std::uint64_t clock_id) {
    std::size_t due = 0;
    while (due < size_ && (at(due).capture_time <= capture || at(due).clock_id != clock_id)) ++due;
    if (due == 0) return nullptr;
    const Hands* newest = &slots_[(begin_ + due - 1) % slots_.size()];
    drop(due);
    return newest;
  }

 private:
  static constexpr Duration kJump = Duration::s(1);
  const Hands& at(std::size_t i) const { return slots_[(begin_ + i) % slots_.size()]; }
  void drop(std::size_t count) {
    begin_ = (begin_ + count) % slots_.size();
    size_ -= count;
  }

  std::array<Hands, 256> slots_;
  std::size_t begin_ = 0;
  std::size_t size_ = 0;
};

}  // namespace dance

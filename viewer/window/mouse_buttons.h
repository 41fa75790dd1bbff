// MouseButtons: a queue of presses and releases of a mouse's buttons. Panels read the mouse once a
// picture, and would miss a click that is shorter. Each picture therefore takes at most one change
// of each button from the queue.
//
// Units/frames: pixels of the window, from its upper left corner.
// Ownership:    plain values; at most kMost changes, further ones are dropped.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>

namespace dance {

class MouseButtons {
 public:
  static constexpr std::size_t kMost = 32;
  static constexpr std::size_t kButtons = 3;

  struct Change {
    std::size_t button = 0;  // below kButtons
    bool is_down = false;
    float x_px = 0.0f;
    float y_px = 0.0f;
  };

  void add(const Change& change) {
    if (change.button < kButtons && count_ < kMost) waiting_[count_++] = change;
  }
  void clear() { count_ = 0; }

  // Calls `use` with each change of the next picture. Returns the number of changes.
  template <class Use>
  std::size_t take(const Use& use) {
    std::bitset<kButtons> changed;
    std::size_t taken = 0;
    while (taken < count_ && !changed[waiting_[taken].button]) {
      changed.set(waiting_[taken].button);
      use(waiting_[taken++]);
    }
    for (std::size_t i = taken; i < count_; ++i) waiting_[i - taken] = waiting_[i];
    count_ -= taken;
    return taken;
  }

 private:
  std::array<Change, kMost> waiting_;
  std::size_t count_ = 0;
};

}  // namespace dance

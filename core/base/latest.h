// One slot between two threads, newest wins: the writer never waits and never fails, the reader
// gets the newest complete value; older ones are overwritten unread and counted.
//
// Ownership: three copies of T inside (triple buffer); never allocates after construction.
// Threads:   one writer, one reader; wait-free for both.
// Failure:   none; overwritten() counts unread values.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace dance {

template <class T>
class Latest {
 public:
  // Writer: puts a value in the slot.
  void put(const T& value) {
    slots_[back_] = value;
    const std::uint8_t previous =
        middle_.exchange(static_cast<std::uint8_t>(back_ | kFresh), std::memory_order_acq_rel);
    if (previous & kFresh) overwritten_.fetch_add(1, std::memory_order_relaxed);
    back_ = previous & kIndex;
  }

  // Reader: the newest value if one came since the last call, else nullptr. Valid until the next
  // call.
  const T* take() {
    if (!(middle_.load(std::memory_order_acquire) & kFresh)) return nullptr;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return &slots_[front_];
  }

  std::uint64_t overwritten() const { return overwritten_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kFresh = 4;
  std::array<T, 3> slots_{};
  std::atomic<std::uint8_t> middle_{1};
  std::uint8_t back_ = 0;   // the writer's
  std::uint8_t front_ = 2;  // the reader's
  std::atomic<std::uint64_t> overwritten_{0};
};

}  // namespace dance

// A bounded queue between two threads that overwrites its oldest entry when it is full and counts
// it: for records that should all be seen if possible (recordings, statistics), never for the
// newest pose (that is latest.h).
//
// Ownership: kCapacity copies of T inside; never allocates after construction.
// Threads:   one writer (push), one reader (pop). T must be trivially copyable: a slot that is
//            overwritten while it is being read is detected by its sequence and read again.
// Failure:   none; overwritten() counts lost entries.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>

namespace dance {

template <class T, std::size_t kCapacity>
class SpscRing {
  static_assert(std::is_trivially_copyable_v<T>);
  static_assert(kCapacity >= 2 && (kCapacity & (kCapacity - 1)) == 0, "a power of two");

 public:
  // Writer: always succeeds.
  void push(const T& value) {
    const std::uint64_t index = written_.load(std::memory_order_relaxed);
    Slot& slot = slots_[index & (kCapacity - 1)];
    slot.sequence.store(2 * index + 1, std::memory_order_relaxed);  // odd: being written
    Words words{};
    std::memcpy(words.data(), &value, sizeof(T));
    // Release: a reader of one of these words also sees the odd sequence.
    for (std::size_t i = 0; i < kWords; ++i)
      slot.words[i].store(words[i], std::memory_order_release);
    slot.sequence.store(2 * index + 2, std::memory_order_release);
    written_.store(index + 1, std::memory_order_release);
  }

  // Reader: the oldest entry that still stands, or nullopt when there is none.
  std::optional<T> pop() {
    for (;;) {
      const std::uint64_t written = written_.load(std::memory_order_acquire);
      if (read_ == written) return std::nullopt;
      if (written - read_ > kCapacity) {
        overwritten_ += written - kCapacity - read_;
        read_ = written - kCapacity;
      }
      const Slot& slot = slots_[read_ & (kCapacity - 1)];
      const std::uint64_t before = slot.sequence.load(std::memory_order_acquire);
      Words words;
      for (std::size_t i = 0; i < kWords; ++i)
        words[i] = slot.words[i].load(std::memory_order_acquire);
      const std::uint64_t after = slot.sequence.load(std::memory_order_relaxed);
      if (before != after || before != 2 * read_ + 2) {  // overwritten while being read
        ++overwritten_;
        ++read_;
        continue;
      }
      ++read_;
      T value;
      std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
      return value;
    }
  }

  // Reader: entries that were overwritten before they were read.
  std::uint64_t overwritten() const { return overwritten_; }

 private:
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;
  using Words = std::array<std::uint64_t, kWords>;
  struct Slot {
    std::atomic<std::uint64_t> sequence{0};
    std::array<std::atomic<std::uint64_t>, kWords> words{};
  };
  std::array<Slot, kCapacity> slots_{};
  std::atomic<std::uint64_t> written_{0};
  std::uint64_t read_ = 0;
  std::uint64_t overwritten_ = 0;
};

}  // namespace dance

// NumberRing: the newest values of one kind in memory that one process writes and others read, none
// waiting for another. The writer numbers its values and only ever writes the entry after the
// newest, so that a reader of the newest is overtaken only when it sleeps for a whole turn of the
// ring; then it knows.
//
// Units/frames: numbers grow with each value and are never used twice, over restarts of the writer
//               neither: an entry's version tells which value is in it. Number 0 is none.
// Ownership:    lies in shared memory: no pointers, all words atomic.
// Threads:      one writer; any number of readers in any processes. Neither waits.
// Failure:      read() says that the value is not there, not there any more or being written; what
//               a hostile writer can do is to give wrong values, which the reader's caller checks.
// Source:       Boehm, Can seqlocks get along with programming language memory models?, MSPC 2012:
//               words stored with release and loaded with acquire, instead of fences, which the
//               thread sanitizer does not know. On x86 both are plain moves.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace dance::engine {

using Word = std::atomic<std::uint64_t>;
static_assert(Word::is_always_lock_free && sizeof(Word) == 8);

template <class T, std::size_t kCount>
struct NumberRing {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(Word) == 0);
  static constexpr std::size_t kWords = sizeof(T) / sizeof(Word);
  static constexpr std::size_t kEntries = kCount;

  struct alignas(64) Entry {
    Word version;  // 2 · number + 2; one less while it is being written
    Word words[kWords];
  };

  alignas(64) Word newest;  // 0: none
  Word first;               // the oldest number of this dancer
  Entry entries[kCount];

  // Writer.
  void write(std::uint64_t number, const T& value) {
    Entry& entry = entries[number % kCount];
    entry.version.store(2 * number + 1, std::memory_order_relaxed);
    std::uint64_t copy[kWords];
    std::memcpy(copy, &value, sizeof value);
    for (std::size_t i = 0; i < kWords; ++i)
      entry.words[i].store(copy[i], std::memory_order_release);
    entry.version.store(2 * number + 2, std::memory_order_release);
    newest.store(number, std::memory_order_release);
  }
  // Nothing is in it, and the next number is `next`.
  void clear(std::uint64_t next) {
    newest.store(0, std::memory_order_release);
    first.store(next, std::memory_order_release);
  }

  // Reader: whether `value` is the one with that number. False: overwritten meanwhile, and then it
  // is of no use.
  bool read(std::uint64_t number, T& value) const {
    const Entry& entry = entries[number % kCount];
    const std::uint64_t version = 2 * number + 2;
    if (entry.version.load(std::memory_order_acquire) != version) return false;
    auto* bytes = reinterpret_cast<unsigned char*>(&value);
    for (std::size_t i = 0; i < kWords; ++i) {
      const std::uint64_t word = entry.words[i].load(std::memory_order_acquire);
      std::memcpy(bytes + i * sizeof word, &word, sizeof word);
    }
    return entry.version.load(std::memory_order_relaxed) == version;
  }
};

}  // namespace dance::engine

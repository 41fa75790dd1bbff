// When each pose of a crowd was sent, for those who hear it: by guest and sequence, in the clock
// that all of one process have. Latencies need no clock of the tunnel's therefore.
//
// Units/frames: MonoTime of this process; sequences of a guest begin at 1 and have no gaps.
// Ownership:    owns the times of each guest's last kKept poses; made once.
// Threads:      a guest is written by one thread and read by any.
// Failure:      sent_at() is not set for what is older than kKept poses, or was never sent.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "core/base/sequence.h"
#include "core/base/time.h"

namespace dance {

class CrowdBoard {
 public:
  static constexpr std::int32_t kKept = 512;

  explicit CrowdBoard(std::size_t guests) : guests_(guests) {}

  std::size_t size() const { return guests_.size(); }
  std::uint32_t newest(std::size_t guest) const {
    return guests_[guest].newest.load(std::memory_order_acquire);
  }
  // Before the pose leaves, as somebody may have it before publish().
  void note(std::size_t guest, std::uint32_t sequence, MonoTime at) {
    cell(guest, sequence).store(at.since_zero_ns(), std::memory_order_release);
  }
  void publish(std::size_t guest, std::uint32_t sequence) {
    guests_[guest].newest.store(sequence, std::memory_order_release);
  }
  MonoTime sent_at(std::size_t guest, std::uint32_t sequence) const {
    const std::int32_t back = sequence_ahead(sequence, newest(guest));
    if (back < -1 || back >= kKept - 2) return MonoTime();
    const auto ns = cell(guest, sequence).load(std::memory_order_acquire);
    return ns == 0 ? MonoTime() : MonoTime::from_ns(ns);
  }

 private:
  struct Guest {
    std::atomic<std::uint32_t> newest{0};
    std::array<std::atomic<std::int64_t>, kKept> sent_ns{};
  };
  std::atomic<std::int64_t>& cell(std::size_t guest, std::uint32_t sequence) {
    return guests_[guest].sent_ns[sequence % kKept];
  }
  const std::atomic<std::int64_t>& cell(std::size_t guest, std::uint32_t sequence) const {
    return guests_[guest].sent_ns[sequence % kKept];
  }

  std::vector<Guest> guests_;
};

}  // namespace dance

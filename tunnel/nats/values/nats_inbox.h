// Values that came from NATS, from the library's threads to the poller's.
//
// Units/frames: none.
// Ownership:    owns what waits, and the descriptor that is readable while something does.
// Threads:      push() from any, the rest from the poller's. The lock is held for one push, or one
//               exchange of two lists.
// Failure:      beyond kMost messages new ones are dropped and counted; of values that one was is
//               told, so that all are read anew.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <vector>

#include "core/net/system/wake_event.h"
#include "tunnel/nats/nats_handles.h"

namespace dance {

class NatsInbox {
 public:
  enum class Kind : std::uint8_t { kValue, kBack, kEmptied };
  struct Item {
    Kind kind = Kind::kValue;
    NatsHandle<natsMsg> message;  // nullptr but for kValue
  };

  explicit NatsInbox(WakeEvent wake);
  NatsInbox(const NatsInbox&) = delete;
  NatsInbox& operator=(const NatsInbox&) = delete;

  void push(Kind kind, NatsHandle<natsMsg> message);
  int fd() const { return wake_.fd(); }
  // All that wait; valid until the next call.
  std::vector<Item>& take();
  // Whether a value was dropped since this was asked last.
  bool take_missed_value() { return missed_value_.exchange(false); }
  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::size_t kMost = 16'384;

  WakeEvent wake_;
  std::mutex mutex_;
  std::vector<Item> waiting_;
  std::vector<Item> taken_;
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<bool> missed_value_{false};
};

}  // namespace dance

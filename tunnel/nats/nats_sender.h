// Publishes in a thread of its own, so that a NATS server that does not read holds up no pose.
//
// Units/frames: none.
// Ownership:    copies what is published; the connection must outlive it.
// Threads:      all but the counters from one thread; no lock and no allocation on the way of a
//               message.
// Failure:      a message that does not fit into the ring, or finds no connection, is dropped and
//               counted: a newer pose comes. What is listened to is subscribed until it is.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "tunnel/cluster/cluster_format.h"
#include "tunnel/cluster/cluster_names.h"
#include "tunnel/nats/nats_inbox.h"

namespace dance {

class NatsSender {
 public:
  NatsSender(natsConnection* connection, NatsInbox& inbox);
  ~NatsSender();
  NatsSender(const NatsSender&) = delete;
  NatsSender& operator=(const NatsSender&) = delete;

  void publish(std::string_view subject, std::span<const std::uint8_t> message) {
    push(subject, message);
  }
  void listen(std::string_view subject);
  void end_listen(std::string_view subject);
  // Waits a moment for what is in the ring: at the program's end.
  void flush(std::chrono::milliseconds longest);

  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  struct Slot {
    cluster::Text subject;
    std::size_t size = 0;
    std::array<std::uint8_t, cluster::kMaxBytes> bytes;
  };
  static constexpr std::size_t kSlots = 2048;

  void push(std::string_view subject, std::span<const std::uint8_t> message);
  void run();
  void publish(const Slot& slot);
  void wake();
  bool settle_subscriptions();
  bool subscribe(const std::string& subject);

  natsConnection* connection_;
  NatsInbox& inbox_;
  int wake_fd_;
  std::vector<Slot> slots_;
  std::atomic<std::uint64_t> pushed_{0};
  std::atomic<std::uint64_t> carried_out_{0};
  std::atomic<bool> sleeps_{false};
  std::atomic<bool> ends_{false};
  std::atomic<std::uint64_t> dropped_{0};
  std::mutex mutex_;
  std::set<std::string> wanted_;  // what is listened to
  std::atomic<bool> wants_change_{false};
  std::map<std::string, NatsHandle<natsSubscription>> subscriptions_;  // the thread's
  std::thread thread_;
};

}  // namespace dance

// Publishes in a thread of its own, so that a NATS server that does not read holds up no pose.
//
// Units/frames: none.
// Ownership:    copies what is published; the connection must outlive it.
// Threads:      publish(), listen() and end_listen() from one thread; no lock and no allocation on
//               the way of a message.
// Failure:      what does not fit into the ring, or finds no connection, is dropped and counted: a
//               newer pose comes.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "tunnel/cluster/cluster_format.h"
#include "tunnel/nats/nats_inbox.h"

namespace dance {

class NatsSender {
 public:
  NatsSender(natsConnection* connection, NatsInbox& inbox);
  ~NatsSender();
  NatsSender(const NatsSender&) = delete;
  NatsSender& operator=(const NatsSender&) = delete;

  void publish(std::string_view subject, std::span<const std::uint8_t> message) {
    push(Kind::kPublish, subject, message);
  }
  void listen(std::string_view subject) { push(Kind::kListen, subject, {}); }
  void end_listen(std::string_view subject) { push(Kind::kEndListen, subject, {}); }

  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  enum class Kind : std::uint8_t { kPublish, kListen, kEndListen };
  struct Slot {
    Kind kind = Kind::kPublish;
    cluster::Text subject;
    std::size_t size = 0;
    std::array<std::uint8_t, cluster::kMaxBytes> bytes;
  };
  static constexpr std::size_t kSlots = 2048;

  void push(Kind kind, std::string_view subject, std::span<const std::uint8_t> message);
  void run();
  void carry_out(const Slot& slot);
  void subscribe(const std::string& subject);

  natsConnection* connection_;
  NatsInbox& inbox_;
  int wake_fd_;
  std::vector<Slot> slots_;
  std::atomic<std::uint64_t> pushed_{0};
  std::atomic<std::uint64_t> carried_out_{0};
  std::atomic<bool> sleeps_{false};
  std::atomic<bool> ends_{false};
  std::atomic<std::uint64_t> dropped_{0};
  std::map<std::string, NatsHandle<natsSubscription>> subscriptions_;  // the thread's
  std::thread thread_;
};

}  // namespace dance

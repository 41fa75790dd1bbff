// Messages over core NATS, in the poller's own thread: no lock, no other thread and no allocation
// lies on the way of a pose. All that a turn publishes goes out in one write. The client library's
// threads are too many wakes for each message, and its external event loop waits inside TLS.
//
// Units/frames: subjects and bytes as ClusterBus.
// Ownership:    owns connection and buffers; the poller must outlive it.
// Threads:      the poller's; new connections are made in one of its own.
// Failure:      at most kMostWaiting bytes wait for a NATS server that does not read, what is more
//               is dropped and counted. Where 32 kB came at once, the newest kKept of each subject
//               are taken. A connection that ends, is silent or is not read is replaced. A subject
//               beyond NatsSubscriptions::kMost is not listened to, which is counted as refused.
#pragma once

#include <functional>

#include "core/net/poller.h"
#include "tunnel/nats/messages/nats_reader.h"
#include "tunnel/nats/messages/nats_subscriptions.h"
#include "tunnel/nats/nats_connector.h"

namespace dance {

class NatsMessages {
 public:
  static constexpr std::size_t kMostWaiting = 131'072;
  static constexpr std::uint32_t kKept = 8;
  using Bytes = std::span<const std::uint8_t>;
  struct Handlers {
    std::function<void(std::string_view subject, Bytes message, MonoTime now)> on_message;
    std::function<void(MonoTime now)> after_batch;
    // There is a connection again.
    std::function<void(MonoTime now)> on_back;
  };
  struct Counters {
    std::uint64_t dropped_in = 0;
    std::uint64_t dropped_out = 0;
    std::uint64_t refused = 0;         // what the NATS server answers to what we say: rights
    std::uint64_t interests_said = 0;  // subjects that began or ended at the NATS server
  };

  static Result<std::unique_ptr<NatsMessages>> connect(const NatsOptions& options, Poller& poller,
                                                       Handlers handlers);
  ~NatsMessages();
  NatsMessages(const NatsMessages&) = delete;
  NatsMessages& operator=(const NatsMessages&) = delete;

  void publish(std::string_view subject, Bytes message);
  void listen(std::string_view subject);
  void end_listen(std::string_view subject);
  // What was published goes out.
  void end_turn(MonoTime now);
  // Waits a moment for what waits: at the program's end.
  void flush(Duration longest);

  bool is_connected() const { return channel_.has_value(); }
  // Nothing of earlier turns waits for the NATS server.
  bool is_clear() const { return channel_.has_value() && !is_stuck_; }
  const Counters& counters() const { return counters_; }

 private:
  NatsMessages(const NatsOptions& options, WakeEvent wake, Poller& poller, Handlers handlers);
  void begin(NatsHandshake opened, MonoTime now);
  void end();
  void on_readable(MonoTime now);
  void take_all(bool is_behind, MonoTime now);
  void count_newest();
  MonoTime tick(MonoTime now);
  void say(std::initializer_list<std::string_view> parts);
  void say_interests();
  MonoTime next_deadline() const;

  Poller& poller_;
  Handlers handlers_;
  NatsConnector connector_;
  std::optional<NatsChannel> channel_;
  NatsReader reader_;
  NatsSubscriptions subjects_;
  std::vector<std::uint8_t> waiting_;  // to be written
  bool is_stuck_ = false;              // not all of earlier turns has been written
  bool owes_pong_ = false;
  MonoTime heard_;
  MonoTime stuck_since_;  // no byte has gone out
  MonoTime write_again_;
  MonoTime read_again_;
  MonoTime next_ping_;
  Poller::TimerId timer_;
  Counters counters_;
};

}  // namespace dance

// Makes connections to any of a cluster's NATS servers, each when it is asked for, in a thread of
// its own: connecting waits, and the poller's thread does not.
//
// Units/frames: none.
// Ownership:    owns thread and descriptor; what is taken is the caller's.
// Threads:      all calls from one. Destruction ends what is being tried within 0.1 s, but for the
//               lookup of a name.
// Failure:      tries until it succeeds, in turn at all servers.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "core/net/system/wake_event.h"
#include "tunnel/nats/messages/nats_handshake.h"

namespace dance {

class NatsConnector {
 public:
  NatsConnector(const NatsOptions& options, WakeEvent wake);
  ~NatsConnector();
  NatsConnector(const NatsConnector&) = delete;
  NatsConnector& operator=(const NatsConnector&) = delete;

  // Once through all servers, now.
  Result<NatsHandshake> connect_now();
  void ask();
  // Readable when what was asked for is there.
  int fd() const { return wake_.fd(); }
  std::optional<NatsHandshake> take();

 private:
  void run();

  NatsOptions options_;
  std::size_t next_;  // of the servers
  WakeEvent wake_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_asked_ = false;
  std::atomic<bool> ends_{false};
  std::optional<NatsHandshake> made_;
  std::chrono::steady_clock::time_point made_at_;  // the newest
  std::thread thread_;
};

}  // namespace dance

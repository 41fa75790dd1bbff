// ClusterBus over NATS: messages by core NATS, which keeps none, in the poller's thread, and values
// in a key-value bucket of JetStream, on another connection. Nothing here waits in the poller's
// thread.
//
// Units/frames: as ClusterBus.
// Ownership:    owns connections and threads; the poller must outlive it.
// Threads:      the poller's, but for what it starts itself.
// Failure:      connect() names what cannot be reached, and what is refused. A connection that is
//               lost later comes back by itself, to any of the NATS servers.
#pragma once

#include <functional>
#include <memory>

#include "core/base/result.h"
#include "core/net/poller.h"
#include "tunnel/cluster/cluster_bus.h"
#include "tunnel/nats/nats_options.h"

namespace dance {

class NatsBus : public ClusterBus {
 public:
  struct Counters {
    std::uint64_t dropped_in = 0;     // more than the poller's thread took
    std::uint64_t dropped_out = 0;    // no connection, or NATS did not read, or refused it
    std::uint64_t failed_values = 0;  // tries that failed; each is tried again
    std::size_t unwritten_values = 0;
    std::uint64_t emptied = 0;  // how often NATS has lost the values
    std::uint64_t reconnects = 0;
    bool is_connected = false;
  };

  // Whether it was built with the NATS client library.
  static bool is_built();
  static Result<std::unique_ptr<NatsBus>> connect(const NatsOptions& options, Poller& poller);

  // After the handlers of each batch that came.
  virtual void set_after_batch(std::function<void(MonoTime now)> work) = 0;
  // Waits a moment for values that are not written yet: at the program's end.
  virtual void flush() = 0;
  virtual Counters counters() const = 0;
};

}  // namespace dance

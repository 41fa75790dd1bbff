// A server's membership in a cluster: NATS between the servers, this server's part in it, and the
// keys that all of them share. The keys have a connection of their own, as no pose waits for them.
//
// Units/frames: MonoTime of the poller's clock.
// Ownership:    owns connections and node; the poller must outlive it, and it the server.
// Threads:      the poller's; the connections have threads of their own.
// Failure:      join() waits for NATS and for the cluster's clock, and says what is missing. From
//               then on a NATS that is away is said once, and the keys stay as they were.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/net/poller.h"
#include "tunnel/cluster/cluster_node.h"
#include "tunnel/nats/nats_bus.h"
#include "tunnel/server/program/cluster/cluster_keys.h"
#include "tunnel/server/program/cluster/cluster_options.h"

namespace dance {

class ClusterMembership {
 public:
  static Result<std::unique_ptr<ClusterMembership>> join(const ClusterOptions& options,
                                                         Poller& poller);

  ClusterNode& node() { return *node_; }
  const ClusterNode& node() const { return *node_; }
  const ClusterKeys& keys() const { return keys_; }
  NatsBus::Counters bus_counters() const { return bus_->counters(); }
  NatsBus::Counters key_bus_counters() const { return key_bus_->counters(); }

  // `work` runs after each batch of messages from other servers.
  void set_after_batch(std::function<void(MonoTime now)> work) {
    bus_->set_after_batch(std::move(work));
  }
  // `work` runs when the cluster's keys have changed.
  void set_on_keys(std::function<void()> work) { on_keys_ = std::move(work); }
  // Call once a second: reports changes of the connection, and keys that are wrong or lost.
  void tell();
  // Call at the program's end.
  void flush() { bus_->flush(); }

 private:
  ClusterMembership() = default;
  Result<void> read_keys(const NatsOptions& nats, Poller& poller);
  Result<void> settle(const NatsOptions& nats, Poller& poller);

  std::unique_ptr<NatsBus> bus_;
  std::unique_ptr<NatsBus> key_bus_;
  std::unique_ptr<ClusterNode> node_;
  ClusterKeys keys_;
  std::function<void()> on_keys_;
  bool was_connected_ = true;
  std::size_t told_others_ = SIZE_MAX;
  std::uint64_t reconnects_ = 0;
  std::uint64_t emptied_ = 0;
  int checks_until_lost_ = 0;
};

}  // namespace dance

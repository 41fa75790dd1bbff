// The tunnel's server on a UDP port: ServerCore behind its door, with a socket around both. What a
// turn brings in is forwarded in the same turn, with batched system calls; an idle server sleeps.
//
// Units/frames: MonoTime of this process's clock.
// Ownership:    owns socket and core; the poller must outlive it.
// Threads:      the poller's.
// Failure:      open() names the port that cannot be had and the cure.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "core/base/result.h"
#include "core/net/poller.h"
#include "core/net/udp_socket.h"
#include "tunnel/cluster/cluster_node.h"
#include "tunnel/seal/seal_server.h"
#include "tunnel/server/server_core.h"

namespace dance {

constexpr std::uint16_t kDefaultServerPort = 7400;

struct ServerOptions {
  ServerLimits limits;
  SealLimits seal;
  PrivateKey identity = PrivateKey::make();
  std::shared_ptr<const KeyRing> keys;  // not nullptr
  std::optional<SealCertificates> certificates;
  ClusterNode* cluster = nullptr;  // settled; must outlive the server. nullptr: it stands alone
  // As SealServer's; not set: invitations open nothing here.
  std::function<void(PeerId, const KeyEntry&, const PublicKey& house)> on_binding;
  // Receives joins, refusals and removals; not set: they are not logged.
  std::function<void(const Address& from, const AuditEvent&)> on_audit;
};

// The current rights of a key's holder.
Access access_of(const KeyEntry& key);

class Server {
 public:
  static Result<std::unique_ptr<Server>> open(const Address& local, const ServerOptions& options,
                                              Poller& poller);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // Replaces all keys.
  void set_keys(std::shared_ptr<const KeyRing> keys);
  // The result of a house's request, see on_binding.
  void answer_binding(PeerId peer, Binding binding);
  // Announces the end to every link and to the cluster, so that none has to wait for a timeout.
  void send_goodbye();
  // Sends on what the cluster delivered. Call after each batch.
  void end_cluster_turn(MonoTime now);
  // The clock that links see: this process's, or the cluster's.
  MonoTime to_session(MonoTime now) const {
    return cluster_ != nullptr ? cluster_->clock().to_session(now) : now;
  }

  Address local_address() const { return socket_.local_address(); }
  const ServerCore& core() const { return core_; }
  const SealServer& door() const { return *door_; }
  const UdpSocket::Counters& socket_counters() const { return socket_.counters(); }

 private:
  // What the state machine sends goes out sealed.
  class Sealed final : public PeerSink {
   public:
    void send(PeerId to, std::span<const std::uint8_t> bytes) override { door->send(to, bytes); }
    SealServer* door = nullptr;
  };

  Server(UdpSocket socket, const ServerLimits& limits, ClusterNode* cluster, Poller& poller);
  void on_readable(MonoTime now);
  MonoTime tick(MonoTime now);
  MonoTime next_deadline() const;
  void end_turn(MonoTime now);

  Poller& poller_;
  UdpSocket socket_;
  Sealed sealed_;
  ServerCore core_;
  std::unique_ptr<SealServer> door_;
  ClusterNode* cluster_;
  MonoTime cluster_due_;
  std::uint64_t clock_steps_ = 0;
  Poller::TimerId timer_;
};

}  // namespace dance

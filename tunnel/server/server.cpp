#include "tunnel/server/server.h"

#include <algorithm>
#include <utility>

#include "core/base/deadline.h"
#include "core/net/secure_random.h"
#include "tunnel/seal/keys/utc_text.h"

namespace dance {
namespace {

// A flood gets this many batches a turn; then timers have their say.
constexpr int kBatchesPerTurn = 8;

}  // namespace

Access access_of(const KeyEntry& key) {
  Access access;
  access.name = key.name;
  access.room = key.room;
  access.any_name = key.kind == KeyKind::kRoom;
  access.is_local = key.is_local();
  access.until_s = key.until_s;
  access.is_expired = key.until_s && key.has_expired(utc_now_s());
  access.role = key.kind == KeyKind::kListener                 ? Role::kListener
                : key.kind == KeyKind::kHost || key.is_local() ? Role::kHost
                                                               : Role::kGuest;
  return access;
}

Result<std::unique_ptr<Server>> Server::open(const Address& local, const ServerOptions& options,
                                             Poller& poller) {
  DANCE_TRY(UdpSocket socket, UdpSocket::serve(local));
  auto server = std::unique_ptr<Server>(
      new Server(std::move(socket), options.limits, options.cluster, poller));
  SealServer::Handlers handlers;
  handlers.on_datagram = [self = server.get()](PeerId from, const KeyEntry& key, wire::Bytes plain,
                                               MonoTime received, MonoTime now) {
    self->core_.receive(from, access_of(key), plain, self->to_session(received),
                        self->to_session(now));
  };
  handlers.on_end = [core = &server->core_](PeerId peer) { core->forget(peer); };
  handlers.on_binding = options.on_binding;
  if (options.on_audit) {
    handlers.on_refused = [on_audit = options.on_audit](const Address& from, std::string_view name,
                                                        SealReject cause) {
      on_audit(from, {.kind = AuditKind::kRefused,
                      .key = name,
                      .cause = kSealRejectNames[static_cast<std::size_t>(cause)]});
    };
    handlers.on_key_removed = [self = server.get(), on_audit = options.on_audit](
                                  PeerId peer, const KeyEntry& key) {
      on_audit(self->door_->address_of(peer),
               {.kind = AuditKind::kRemoved, .key = key.name.view(), .cause = "key_removed"});
    };
    server->core_.set_on_audit(
        [self = server.get(), on_audit = options.on_audit](PeerId peer, const AuditEvent& event) {
          on_audit(self->door_->address_of(peer), event);
        });
  }
  SealLimits seal = options.seal;
  // A link that reconnects has two for a while.
  seal.peers = std::max(seal.peers, 2 * options.limits.sessions);
  seal.peers_per_key = std::max(seal.peers_per_key, 2 * options.limits.sessions_per_key);
  seal.peers_per_shared_key = std::max(seal.peers_per_shared_key, options.limits.sessions);
  DANCE_TRY(server->door_,
            SealServer::make(seal, options.identity, options.keys, options.certificates,
                             secure_random_u64, std::move(handlers), server->socket_));
  server->sealed_.door = server->door_.get();
  server->core_.set_reserved([self = server.get()](const GuestId& name) {
    return self->door_->keys().is_own_name(name.view());
  });
  return server;
}

Server::Server(UdpSocket socket, const ServerLimits& limits, ClusterNode* cluster, Poller& poller)
    : poller_(poller),
      socket_(std::move(socket)),
      core_(limits, secure_random_u64, sealed_),
      cluster_(cluster) {
  if (cluster_ != nullptr) {
    cluster_->attach(core_);
    cluster_due_ = MonoTime::from_ns(1);  // at once, whatever else comes first
    clock_steps_ = cluster_->clock().steps();
  }
  poller_.watch(socket_.fd(), [this](MonoTime now) { on_readable(now); });
  timer_ = poller_.add_timer(cluster_due_, [this](MonoTime now) { return tick(now); });
}

void Server::end_turn(MonoTime now) {
  core_.end_turn(to_session(now));
  if (cluster_ != nullptr) cluster_->end_turn(now);
}

void Server::end_cluster_turn(MonoTime now) {
  end_turn(now);
  socket_.flush();
  poller_.set_deadline(timer_, next_deadline());
}

MonoTime Server::tick(MonoTime now) {
  if (cluster_ != nullptr) {
    cluster_due_ = cluster_->tick(now);
    // Two halves of a cluster that began apart have met: what the old clock said is void.
    if (std::exchange(clock_steps_, cluster_->clock().steps()) != cluster_->clock().steps())
      core_.end_sessions();
    core_.set_other_servers(cluster_->peers().addresses());
  }
  core_.tick(to_session(now));
  if (cluster_ != nullptr) cluster_->end_turn(now);
  door_->tick(now);
  socket_.flush();
  return next_deadline();
}

MonoTime Server::next_deadline() const {
  MonoTime core = core_.next_deadline();
  if (core.is_set() && cluster_ != nullptr) core = cluster_->clock().to_ours(core);
  return earlier(core, earlier(door_->next_deadline(), cluster_due_));
}

void Server::set_keys(std::shared_ptr<const KeyRing> keys) {
  door_->set_keys(std::move(keys));
  socket_.flush();
}

void Server::answer_binding(PeerId peer, Binding binding) {
  door_->answer_binding(peer, binding);
  socket_.flush();
}

Server::~Server() {
  poller_.set_deadline(timer_, MonoTime());
  poller_.unwatch(socket_.fd());
}

void Server::on_readable(MonoTime now) {
  for (int i = 0; i < kBatchesPerTurn; ++i) {
    const auto batch = socket_.receive();
    for (const UdpSocket::Datagram& datagram : batch)
      door_->receive(datagram.from, datagram.bytes, datagram.received, now);
    end_turn(now);
    socket_.flush();
    if (batch.size() < UdpSocket::kBatch) break;
  }
  poller_.set_deadline(timer_, next_deadline());
}

void Server::send_goodbye() {
  // First: links may ask the others at once.
  if (cluster_ != nullptr) cluster_->leave();
  core_.send_goodbye();
  socket_.flush();
}

}  // namespace dance

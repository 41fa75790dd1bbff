// A server with a real socket. It lists the servers that a test chooses, and sends a goodbye when
// the test requests one. Call tick() in each turn of the test.
//
// Ownership:    owns its socket; the poller must outlive it.
// Threads:      the poller's.
// Failure:      aborts when its address is taken.
#pragma once

#include <cstdlib>
#include <initializer_list>
#include <memory>

#include "core/net/poller.h"
#include "core/net/secure_random.h"
#include "core/net/udp_socket.h"
#include "tunnel/server/server.h"

namespace dance {

class ListingServer {
 public:
  ListingServer(const Address& local, const PrivateKey& identity,
                std::shared_ptr<const KeyRing> keys, Poller& poller)
      : poller_(poller), socket_(open(local)), core_({}, secure_random_u64, sealed_) {
    SealServer::Handlers handlers;
    handlers.on_datagram = [this](PeerId from, const KeyEntry& key, wire::Bytes plain,
                                  MonoTime received, MonoTime now) {
      core_.receive(from, access_of(key), plain, received, now);
    };
    handlers.on_end = [this](PeerId peer) { core_.forget(peer); };
    auto door = SealServer::make({}, identity, std::move(keys), std::nullopt, secure_random_u64,
                                 std::move(handlers), socket_);
    if (!door) std::abort();
    door_ = std::move(*door);
    sealed_.door = door_.get();
    poller_.watch(socket_.fd(), [this](MonoTime now) { on_readable(now); });
  }
  ~ListingServer() { poller_.unwatch(socket_.fd()); }
  ListingServer(const ListingServer&) = delete;
  ListingServer& operator=(const ListingServer&) = delete;

  void list(std::initializer_list<Address> others) {
    wire::ServerList servers;
    for (const Address& other : others)
      if (!servers.try_push(other)) std::abort();
    list(servers);
  }
  void list(const wire::ServerList& servers) {
    core_.set_other_servers(servers);
    socket_.flush();
  }
  void send_goodbye() {
    core_.send_goodbye();
    socket_.flush();
  }
  void tick(MonoTime now) {
    core_.tick(now);
    door_->tick(now);
    socket_.flush();
  }
  Address address() const { return socket_.local_address(); }
  std::size_t sessions() const { return core_.session_count(); }
  std::uint64_t datagrams() const { return door_->counters().datagrams_in; }
  std::uint64_t poses() const { return core_.counters().records_in; }

 private:
  struct Sealed final : PeerSink {
    void send(PeerId to, std::span<const std::uint8_t> bytes) override { door->send(to, bytes); }
    SealServer* door = nullptr;
  };
  static UdpSocket open(const Address& local) {
    auto socket = UdpSocket::bind(local);
    if (!socket) std::abort();
    return std::move(*socket);
  }
  void on_readable(MonoTime now) {
    for (const UdpSocket::Datagram& datagram : socket_.receive())
      door_->receive(datagram.from, datagram.bytes, datagram.received, now);
    core_.end_turn(now);
    socket_.flush();
  }

  Poller& poller_;
  UdpSocket socket_;
  Sealed sealed_;
  ServerCore core_;
  std::unique_ptr<SealServer> door_;
};

}  // namespace dance
